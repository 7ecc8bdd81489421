"""The learner's progress: read in the background, and changed by checks and hints."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from tutor.content import CriterionText
from tutor.errors import StorageError
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.tui import commands, messages
from tutor.tui.control.host import HostScreen
from tutor.workspace import Progress


class Records:
    """Reads and changes the progress on disk, and posts `ProgressRead` after each."""

    def __init__(self, host: HostScreen) -> None:
        self._host = host
        self._lock = asyncio.Lock()
        host.register(commands.HINT, self.hint)
        host.register(commands.ATTEMPTS, self.attempts)

    def read(self) -> None:
        """Read the progress from disk."""
        self._start_change(self._host.model.session.progress)

    def read_all(self) -> None:
        """Read the progress from disk, and what the last check of each exercise found."""
        self._host.start_worker(self._read_all, group="progress")

    async def _read_all(self) -> None:
        session = self._host.model.session
        progress = await self.change(session.progress)
        last = await self.run_in_order(session.last_checks, progress)
        self._host.post_message(messages.LastChecksRead(last))

    def record_attempt(self, result: ExerciseResult) -> None:
        """Record one attempt."""
        self._host.start_worker(self._record_attempt, result, group="progress")

    async def _record_attempt(self, result: ExerciseResult) -> None:
        await self.change(self._host.model.session.record, result)
        self._host.post_message(messages.AttemptRecorded(result))

    def hint(self) -> None:
        """Show the hint for the failed criterion, if any, and the general hints seen so far (else the first)."""
        model = self._host.model
        failed = self._failed()
        self._show_hints(max(0 if failed else 1, model.progress.of(model.lesson.id).hints), failed)

    def _failed(self) -> CriterionText | None:
        """Return the chosen criterion if it has failed, else the first that has; None if there is no hint for it."""
        model = self._host.model
        failed = [
            finding.id
            for finding in sorted(model.findings[model.lesson.id].criteria, key=lambda finding: finding.bonus)
            if finding.verdict is not None and finding.verdict.status is Status.FAILED
        ]
        wanted = self._host.chosen_criterion if self._host.chosen_criterion in failed else next(iter(failed), "")
        return next(
            (criterion for criterion in model.lesson.criteria if criterion.id == wanted and criterion.hint), None
        )

    def _show_hints(self, count: int, failed: CriterionText | None) -> None:
        from tutor.tui.dialogs.simple import HintScreen

        model = self._host.model
        lesson = model.lesson
        if count > model.progress.of(lesson.id).hints:
            self._start_change(model.session.show_hint, lesson)
        elif failed is not None and not model.progress.of(lesson.id).criterion_hint:
            self._start_change(model.session.show_criterion_hint, lesson)

        def answered(more: bool | None) -> None:
            if more:
                self._show_hints(count + 1, failed)

        self._host.app.push_screen(HintScreen(lesson, count, failed), answered)

    def note_solution(self) -> None:
        """Note that the solution of the current exercise was shown."""
        model = self._host.model
        if model.progress.of(model.lesson.id).solution_at is None:
            self._start_change(model.session.show_solution, model.lesson)

    def attempts(self) -> None:
        """Show the attempts at the current exercise."""
        from tutor.tui.dialogs.simple import AttemptsScreen

        model = self._host.model
        self._host.app.push_screen(AttemptsScreen(model.lesson, model.progress.of(model.lesson.id)))

    def _start_change(self, change: Callable[..., Progress], *args: Any) -> None:
        self._host.start_worker(self.change, change, *args, group="progress")

    async def change(self, change: Callable[..., Progress], *args: Any) -> Progress:
        """Change the progress on disk; post and return the result or, if that fails, the progress as it was."""
        model = self._host.model

        def change_and_read() -> tuple[Progress, dict[str, str]]:
            return change(*args), model.session.versions()

        try:
            progress, versions = await self.run_in_order(change_and_read)
        except StorageError as error:
            self._host.show_error(f"Your progress could not be saved: {error}")
            progress, versions = model.progress, dict(model.versions)
        self._host.post_message(messages.ProgressRead(progress, versions))
        return progress

    async def run_in_order[T](self, work: Callable[..., T], *args: Any) -> T:
        """Run `work(*args)` in a thread, one call at a time, so that results arrive in the order of the calls."""
        async with self._lock:
            return await asyncio.to_thread(work, *args)
