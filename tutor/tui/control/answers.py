"""Exercises that hand over a system: the learner's answer, and another fault."""

from __future__ import annotations

import asyncio

from tutor.content import Lesson
from tutor.content.cases import has_cases
from tutor.errors import StorageError, UsageError, WorkspaceError
from tutor.session.paths import short_path
from tutor.tui import commands, messages, wording
from tutor.tui.control.checks import Checks
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.nodes import Nodes
from tutor.tui.control.skeletons import Skeletons


class Answers:
    """Asks what is wrong with the system, and where; and hands over another one."""

    def __init__(self, host: HostScreen, files: Files, skeletons: Skeletons, nodes: Nodes, checks: Checks) -> None:
        self._host, self._files, self._skeletons = host, files, skeletons
        self._nodes, self._checks = nodes, checks
        host.register(commands.ANSWER, self.ask, self._is_asked)
        host.register(commands.ANOTHER, self.offer_another, self._is_asked)

    def _is_asked(self) -> bool:
        return has_cases(self._host.model.lesson)

    def ask(self) -> None:
        """Ask what it is, and where, and write it into the report."""
        if not self._skeletons.offer_start_if_missing("answer"):
            self._host.start_worker(self._ask, self._host.model.lesson, group="answer", exclusive=True)

    async def _ask(self, lesson: Lesson) -> None:
        from tutor.tui.dialogs.answer import AnswerScreen

        session = self._host.model.session
        try:
            question = await asyncio.to_thread(session.handed_over.question, lesson)
            screen = AnswerScreen(f"{wording.label(lesson)}: your answer", question)
            answer: tuple[str, str] | None = await self._host.app.push_screen_wait(screen)
            if answer is None:
                return
            report = await self._files.let_change((question.path,), session.handed_over.answer, lesson, *answer)
        except (UsageError, StorageError) as error:
            self._host.show_error(str(error))
            return
        if report is None:
            return
        self._host.post_message(messages.FileSaved(question.path))
        self._host.say(f"Reported: {question.cases.kinds[report.what]}, in {report.where}. F9 judges it.")

    def offer_another(self) -> None:
        """Hand over another fault, after asking for confirmation."""
        if self._skeletons.offer_start_if_missing("exchange"):
            return
        lesson = self._host.model.lesson
        text = "You get the system with another fault.\n\nYour files are moved to a folder that keeps them."
        found = self._host.model.session.handed_over.drawn(lesson).describe()
        self._host.ask(
            f"Another fault for {wording.label(lesson)}", f"{text}\n{found}".strip(), "Hand it over", self._draw
        )

    def _draw(self) -> None:
        self._host.start_worker(self._draw_now, self._host.model.lesson, group="start", exclusive=True)

    async def _draw_now(self, lesson: Lesson) -> None:
        session = self._host.model.session
        paths = [session.path(file) for file in lesson.files]
        try:
            await self._nodes.end_all_of(lesson)  # they are of the system that is replaced
            placed = await self._files.let_change(paths, session.start, lesson, another=True)
        except (WorkspaceError, StorageError) as error:
            self._host.show_error(str(error))
            return
        if placed is None:
            return
        self._checks.forget(lesson)
        kept = f" Your files are kept in {short_path(placed.backups[0])}." if placed.backups else ""
        self._host.say(f"Another fault is handed over: r runs the system.{kept}")
