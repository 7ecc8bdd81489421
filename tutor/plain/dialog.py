"""The talk itself: a question, a command, its answer, and so on until the learner leaves."""

from __future__ import annotations

import asyncio
import signal
import sys
from collections.abc import Callable
from difflib import get_close_matches

from tutor.errors import CommandRefused, StorageError, WorkspaceError
from tutor.plain.checklist_commands import ChecklistCommands
from tutor.plain.checks import Checks
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.plain.lessons import Lessons
from tutor.plain.lines import Lines
from tutor.plain.nodes import Nodes
from tutor.plain.ros2_commands import Ros2Commands
from tutor.plain.speech import counted
from tutor.ros import stale_segments
from tutor.session import Session
from tutor.session.paths import short_path
from tutor.terminal_text import printable

INTERRUPTED = 130

_PROMPT = "Command: "
_STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def run_dialog(session: Session, out: Callable[[str], None]) -> int:
    """Talk until the learner leaves, or their input ends: 0. Ctrl+C: 130. Nothing that was started is left."""
    return asyncio.run(_until_stopped(session, out))


async def _until_stopped(session: Session, out: Callable[[str], None]) -> int:
    dialog = Dialog(session, Lines.of_stdin(), out)
    talking = asyncio.ensure_future(dialog.run())
    stopped = False

    def stop() -> None:
        nonlocal stopped
        if not stopped:  # an impatient second Ctrl+C must not break off the clean-up
            stopped = True
            talking.cancel()

    loop = asyncio.get_running_loop()
    for number in _STOP_SIGNALS:
        loop.add_signal_handler(number, stop)
    try:
        await talking
    except asyncio.CancelledError:
        out("\nStopped; nothing that was started is left.\n")
        return INTERRUPTED
    return 0


class Dialog:
    """The commands, and the prompt that takes them."""

    def __init__(self, session: Session, lines: Lines, out: Callable[[str], None]) -> None:
        self._session, self._lines, self._out = session, lines, out
        self._echo = sys.stdin is None or not sys.stdin.isatty()
        self._over = False
        self._conversation = Conversation(session, self._say, self._ask)
        self._nodes = Nodes(self._conversation)
        self._commands = (
            *Lessons(self._conversation).commands,
            *self._nodes.commands,
            *Ros2Commands(self._conversation).commands,
            *Checks(self._conversation).commands,
            *ChecklistCommands(self._conversation).commands,
            DialogCommand("help", "say what you can do", self._help, others=("?",)),
            DialogCommand("quit", "stop everything and leave", self._quit, others=("exit", "bye")),
        )

    async def run(self) -> None:
        """Greet, then do what is asked for, until the learner leaves."""
        self._greet()
        try:
            while not self._over:
                self._nodes.report_ended()
                line = await self._ask(_PROMPT)
                if line is None:
                    self._say("The input has ended.")
                    await self._quit([])
                elif words := line.split():
                    await self._do(words)
        finally:
            await self._nodes.leave()
            stale_segments.remove()

    def _greet(self) -> None:
        lessons, progress = self._session.lessons, self._session.progress()
        passed = sum(progress.of(lesson.id).is_passed for lesson in lessons)
        root = short_path(self._session.workspace.root)
        self._say(f"ROS Tutor in plain lines. {counted(len(lessons), 'lesson')}, {passed} passed.")
        if self._session.workspace.exists:
            self._say(f"Your workspace is {root}; its ROS domain is {self._session.domain}.")
        else:
            self._say(f"Your workspace will be {root}: start creates it.")
        self._say(f"You are at {self._conversation.about(self._conversation.lesson, progress)}")
        self._say("read reads the lesson, start puts in the skeleton, check judges it; help says what else you can do.")

    async def _do(self, words: list[str]) -> None:
        try:
            name, *rest = words
            if name.isdecimal() or (len(name) > 1 and name[0] in "iI" and name[1].isdecimal()):
                self._conversation.open_lesson(self._conversation.find(name))
            else:
                await self._find(name.lower()).do(rest)
        except (CommandRefused, WorkspaceError, StorageError) as error:
            self._say(str(error))

    def _find(self, name: str) -> DialogCommand:
        known = {each: command for command in self._commands for each in (command.name, *command.others)}
        if name in known:
            return known[name]
        near = get_close_matches(name, known, n=1)
        guess = f" Did you mean {near[0]}?" if near else ""
        raise CommandRefused(f"There is no command {name}.{guess} help lists them all.")

    async def _help(self, words: list[str]) -> None:
        for command in self._commands:
            self._say(f"{' '.join(part for part in (command.name, command.follows) if part)}: {command.text}.")

    async def _quit(self, words: list[str]) -> None:
        self._over = True
        await self._nodes.leave()
        self._nodes.report_ended()
        self._say("Goodbye. Your progress is kept." if self._session.workspace.exists else "Goodbye.")

    async def _ask(self, question: str) -> str | None:
        self._out(question)
        line = await self._lines.next()
        if self._echo or line is None:  # a terminal has shown what was typed, and gone to the next line
            self._out(f"{printable(line or '')}\n")
        return line

    def _say(self, line: str) -> None:
        self._out(f"{printable(line)}\n")
