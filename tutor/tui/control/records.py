"""The learner's progress: read in the background, and changed by checks and hints."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from tutor.content import CriterionText
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.tui import messages
from tutor.tui.screens.hint import HintScreen
from tutor.tui.screens.stage import Deed, Stage
from tutor.workspace import Progress, StorageError


class Records:
    """Tells each new state of the progress by `ProgressRead`."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._lane = asyncio.Lock()
        self.deeds = {"hint": Deed(self.hint), "attempts": Deed(self.attempts)}

    def read(self) -> None:
        """Read it from the disk."""
        self._work(self._stage.session.desk.progress)

    def add(self, result: ExerciseResult) -> None:
        """Keep one attempt."""
        self._work(self._stage.session.desk.record, result)

    def hint(self) -> None:
        """Show the hint for what has failed, and the general ones that were shown before; else the first of these."""
        session = self._stage.session
        failed = self._failed()
        self._show_hints(max(0 if failed else 1, session.progress.of(session.lesson.id).hints), failed)

    def _failed(self) -> CriterionText | None:
        """The criterion that is chosen, if it has failed; else the first that has."""
        session = self._stage.session
        failed = [
            finding.id
            for finding in sorted(session.findings[session.lesson.id].criteria, key=lambda finding: finding.bonus)
            if finding.verdict is not None and finding.verdict.status is Status.FAILED
        ]
        wanted = self._stage.chosen_criterion if self._stage.chosen_criterion in failed else next(iter(failed), "")
        return next((each for each in session.lesson.criteria if each.id == wanted and each.hint), None)

    def _show_hints(self, count: int, failed: CriterionText | None) -> None:
        session = self._stage.session
        lesson = session.lesson
        if count > session.progress.of(lesson.id).hints:
            self._work(session.desk.show_hint, lesson)

        def answered(more: bool | None) -> None:
            if more:
                self._show_hints(count + 1, failed)

        self._stage.app.push_screen(HintScreen(lesson, count, failed), answered)

    def attempts(self) -> None:
        """Show the attempts at this exercise."""
        from tutor.tui.screens.attempts import AttemptsScreen

        session = self._stage.session
        self._stage.app.push_screen(AttemptsScreen(session.lesson, session.progress.of(session.lesson.id)))

    def _work(self, change: Callable[..., Progress], *given: Any) -> None:
        self._stage.work(self.change, change, *given, group="progress")

    async def change(self, change: Callable[..., Progress], *given: Any) -> None:
        """Change the progress on the disk, and tell what it is then; where that fails, what it was."""
        try:
            self._stage.post_message(messages.ProgressRead(await self.in_turn(change, *given)))
        except StorageError as error:
            self._stage.trouble(f"Your progress is not kept: {error}")
            self._stage.post_message(messages.ProgressRead(self._stage.session.progress))

    async def in_turn[T](self, work: Callable[..., T], *given: Any) -> T:
        """Do this in a thread, after what was asked for before it: the last that is told is then the latest."""
        async with self._lane:
            return await asyncio.to_thread(work, *given)
