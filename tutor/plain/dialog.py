"""The dialog: prompt, command, answer, and so on until the learner leaves."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from difflib import get_close_matches

from tutor.content import Counts
from tutor.errors import CommandRefused, StorageError, WorkspaceError
from tutor.judge.wording import counted
from tutor.plain.answers import Answers
from tutor.plain.checklist_commands import ChecklistCommands
from tutor.plain.checks import Checks
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.plain.lessons import Lessons
from tutor.plain.lines import LineReader
from tutor.plain.nodes import Nodes
from tutor.plain.predictions import Predictions
from tutor.plain.ros2_commands import Ros2Commands
from tutor.ros import stale_segments
from tutor.session import Session
from tutor.session.paths import short_path
from tutor.stop_signals import Stopped, run_until_stopped
from tutor.terminal_text import printable

INTERRUPTED = 130

_PROMPT = "Command: "
_LESSON_ID = re.compile(r"(?:[a-z][a-z0-9_-]*:)?[a-z]+[0-9]+[._0-9]*", re.IGNORECASE)


def run_dialog(session: Session, out: Callable[[str], None]) -> int:
    """Run the dialog. Return 0 at its end, or 130 after Ctrl+C. In either case, no process is left running."""
    try:
        run_until_stopped(lambda: Dialog(session, LineReader.from_stdin(), out).run())
    except Stopped:
        out("\nStopped; nothing is left running.\n")
        return INTERRUPTED
    return 0


class Dialog:
    """The commands, and the prompt that reads them."""

    def __init__(self, session: Session, lines: LineReader, out: Callable[[str], None]) -> None:
        self._session, self._lines, self._out = session, lines, out
        self._echo_input = sys.stdin is None or not sys.stdin.isatty()
        self._is_over = False
        self._conversation = Conversation(session, self._say, self._ask)
        self._nodes = Nodes(self._conversation)
        self._commands = (
            *Lessons(self._conversation).commands,
            *self._nodes.commands,
            *Ros2Commands(self._conversation).commands,
            *Checks(self._conversation).commands,
            *Answers(self._conversation).commands,
            *Predictions(self._conversation).commands,
            *ChecklistCommands(self._conversation).commands,
            DialogCommand("help", "list all commands", self._help, aliases=("?",)),
            DialogCommand("quit", "stop everything and leave", self._quit, aliases=("exit", "bye")),
        )

    async def run(self) -> None:
        """Greet, then run commands until the learner leaves."""
        self._greet()
        try:
            while not self._is_over:
                self._nodes.report_ended()
                line = await self._ask(_PROMPT)
                if line is None:
                    self._say("The input has ended.")
                    await self._quit([])
                elif words := line.split():
                    await self._run_command(words)
        finally:
            await self._nodes.stop_all()
            stale_segments.remove()

    def _greet(self) -> None:
        lessons, progress = self._session.lessons, self._session.progress()
        counts = Counts.of(lessons, [lesson.id for lesson in lessons if progress.of(lesson.id).is_passed])
        beyond = f"; {counts.beyond} more go beyond the course, {counts.passed_beyond} passed" if counts.beyond else ""
        root = short_path(self._session.workspace.root)
        self._say(f"ROS Tutor in plain lines. {counted(counts.total, 'lesson')}, {counts.passed} passed{beyond}.")
        if self._session.workspace.exists:
            self._say(f"Your workspace is {root}; its ROS domain is {self._session.domain}.")
        else:
            self._say(f"Your workspace will be {root}: start creates it.")
        self._say(f"You are at {self._conversation.describe(self._conversation.lesson, progress)}")
        self._say(
            "read reads the lesson, start adds the skeleton, check judges your code; help says what else you can do."
        )

    async def _run_command(self, words: list[str]) -> None:
        try:
            name, *rest = words
            if name.isdecimal() or _LESSON_ID.fullmatch(name):
                self._conversation.open_lesson(self._conversation.find_lesson(name))
            else:
                await self._find_command(name.lower()).run(rest)
        except (CommandRefused, WorkspaceError, StorageError) as error:
            self._say(str(error))

    def _find_command(self, name: str) -> DialogCommand:
        commands = {word: command for command in self._commands for word in (command.name, *command.aliases)}
        if name in commands:
            return commands[name]
        close_matches = get_close_matches(name, commands, n=1)
        guess = f" Did you mean {close_matches[0]}?" if close_matches else ""
        raise CommandRefused(f"There is no command {name}.{guess} help lists them all.")

    async def _help(self, words: list[str]) -> None:
        for command in self._commands:
            self._say(f"{' '.join(part for part in (command.name, command.arguments) if part)}: {command.text}.")

    async def _quit(self, words: list[str]) -> None:
        self._is_over = True
        await self._nodes.stop_all()
        self._nodes.report_ended()
        self._say("Goodbye. Your progress is kept." if self._session.workspace.exists else "Goodbye.")

    async def _ask(self, question: str) -> str | None:
        self._out(question)
        line = await self._lines.next()
        if self._echo_input or line is None:  # a terminal has already echoed the line
            self._out(f"{printable(line or '')}\n")
        return line

    def _say(self, line: str) -> None:
        self._out(f"{printable(line)}\n")
