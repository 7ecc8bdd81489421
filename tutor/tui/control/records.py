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
from tutor.tui.dialogs.hint import HintScreen
from tutor.workspace import Progress


class Records:
    """Tells each new state of the progress by `ProgressRead`."""

    def __init__(self, host: HostScreen) -> None:
        self._host = host
        self._lane = asyncio.Lock()
        host.register(commands.HINT, self.hint)
        host.register(commands.ATTEMPTS, self.attempts)

    def read(self) -> None:
        """Read it from the disk."""
        self._work(self._host.model.session.progress)

    def add(self, result: ExerciseResult) -> None:
        """Keep one attempt."""
        self._work(self._host.model.session.record, result)

    def hint(self) -> None:
        """Show the hint for what has failed, and the general ones that were shown before; else the first of these."""
        model = self._host.model
        failed = self._failed()
        self._show_hints(max(0 if failed else 1, model.progress.of(model.lesson.id).hints), failed)

    def _failed(self) -> CriterionText | None:
        """The criterion that is chosen, if it has failed; else the first that has."""
        model = self._host.model
        failed = [
            finding.id
            for finding in sorted(model.findings[model.lesson.id].criteria, key=lambda finding: finding.bonus)
            if finding.verdict is not None and finding.verdict.status is Status.FAILED
        ]
        wanted = self._host.chosen_criterion if self._host.chosen_criterion in failed else next(iter(failed), "")
        return next((each for each in model.lesson.criteria if each.id == wanted and each.hint), None)

    def _show_hints(self, count: int, failed: CriterionText | None) -> None:
        model = self._host.model
        lesson = model.lesson
        if count > model.progress.of(lesson.id).hints:
            self._work(model.session.show_hint, lesson)

        def answered(more: bool | None) -> None:
            if more:
                self._show_hints(count + 1, failed)

        self._host.app.push_screen(HintScreen(lesson, count, failed), answered)

    def attempts(self) -> None:
        """Show the attempts at this exercise."""
        from tutor.tui.dialogs.attempts import AttemptsScreen

        model = self._host.model
        self._host.app.push_screen(AttemptsScreen(model.lesson, model.progress.of(model.lesson.id)))

    def _work(self, change: Callable[..., Progress], *given: Any) -> None:
        self._host.work(self.change, change, *given, group="progress")

    async def change(self, change: Callable[..., Progress], *given: Any) -> None:
        """Change the progress on the disk, and tell what it is then; where that fails, what it was."""
        try:
            self._host.post_message(messages.ProgressRead(await self.run_in_order(change, *given)))
        except StorageError as error:
            self._host.show_error(f"Your progress is not kept: {error}")
            self._host.post_message(messages.ProgressRead(self._host.model.progress))

    async def run_in_order[T](self, work: Callable[..., T], *given: Any) -> T:
        """Do this in a thread, after what was asked for before it: what is reported last is then the latest."""
        async with self._lane:
            return await asyncio.to_thread(work, *given)
