"""The learner's progress: read in the background, and changed by checks and hints."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from tutor.judge.result import ExerciseResult
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
        """Show the hints that were shown before, or the first."""
        session = self._stage.session
        self._show_hints(max(1, session.progress.of(session.lesson.id).hints))

    def _show_hints(self, count: int) -> None:
        session = self._stage.session
        lesson = session.lesson
        if count > session.progress.of(lesson.id).hints:
            self._work(session.desk.show_hint, lesson)

        def answered(more: bool | None) -> None:
            if more:
                self._show_hints(count + 1)

        self._stage.app.push_screen(HintScreen(lesson, count), answered)

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
