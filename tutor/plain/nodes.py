"""Commands to run, read and stop the learner's node and its partner while the dialog goes on."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from tutor.content import LessonFile
from tutor.errors import CommandError, CommandRefused
from tutor.judge.wording import counted
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.report.plain import one_line
from tutor.session.node import Node, NodeState, Phase
from tutor.session.node_command import NodeCommand

_FIRST_LINE_TIMEOUT_S = 5.0
"""How long `log` waits for a node's first line, in seconds."""

_DEFAULT_LINES = 10


class Nodes:
    """At most one node per file, and one per partner. The end of a node is reported once, before the next prompt."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self._nodes: dict[Path, Node] = {}
        """The latest node of each file; partners by their `Partner.key`."""
        self._tasks: set[asyncio.Task[None]] = set()
        self._latest: Node | None = None
        self._latest_partner: Node | None = None
        self._unreported: list[tuple[str, Node]] = []
        self._changed = asyncio.Event()
        self.commands = (
            DialogCommand("run", "run your node; with a number, that file of the lesson", self.run, "[NUMBER]"),
            DialogCommand(
                "partner",
                "run our node that goes with yours, such as the given system; with a number, with that file",
                self.partner,
                "[NUMBER]",
            ),
            DialogCommand(
                "log",
                f"read the last {_DEFAULT_LINES} lines that your node wrote, or NUMBER of them; log partner reads ours",
                self.log,
                "[partner] [NUMBER]",
            ),
            DialogCommand(
                "stop", "stop all nodes, as Ctrl+C does; stop partner stops only ours", self.stop, "[partner]"
            ),
        )

    async def run(self, words: list[str]) -> None:
        """Run a file of the lesson with the run options saved in the app."""
        session, lesson = self._conversation.session, self._conversation.lesson
        file = self._find_file(words)
        path = session.path(file)
        if not path.exists():
            raise CommandRefused(f"{file.name} is not in your workspace yet: say start.")
        if self._is_alive(path):
            raise CommandRefused(f"{file.name} is already running: stop ends it.")
        self._latest = await self._start(
            path,
            f"Your node {file.name}",
            lambda: session.node_command(file, session.app_state().run_of(lesson.id)),
        )

    async def partner(self, words: list[str]) -> None:
        """Run our node that goes with a file of the lesson."""
        session, lesson = self._conversation.session, self._conversation.lesson
        file = self._find_file(words)
        partner = lesson.live.partner_of(file.name)
        if partner is None:
            raise CommandRefused(f"This lesson has no partner: no node of ours goes with {file.name}.")
        if self._is_alive(partner.key):
            raise CommandRefused("The partner is already running: stop partner ends it.")
        if any(path.name == partner.key.name and self._is_alive(path) for path in map(session.path, lesson.files)):
            raise CommandRefused(f"Your {partner.key.name} is already running, and does what ours would: stop ends it.")
        name = f"{partner.name[0].upper()}{partner.name[1:]}"
        self._conversation.say(f"{name}: {partner.does}.")
        self._latest_partner = await self._start(
            partner.key, name, lambda: session.partner_command(partner), which=" partner"
        )

    def _find_file(self, words: list[str]) -> LessonFile:
        """Return the file with the number given, else the first. Raises CommandRefused."""
        files = self._conversation.lesson.files
        number = int(words[0]) if words and words[0].isdecimal() else 1
        if not 1 <= number <= len(files):
            raise CommandRefused(f"This lesson has {counted(len(files), 'file')}.")
        return files[number - 1]

    def _is_alive(self, key: Path) -> bool:
        return key in self._nodes and self._nodes[key].state.alive

    async def _start(self, key: Path, name: str, make_command: Callable[[], NodeCommand], which: str = "") -> Node:
        """Start a node, and say so. `which` is what `log` and `stop` take to mean it. Raises CommandRefused."""
        try:
            command = await asyncio.to_thread(make_command)
        except (CommandError, OSError) as error:
            raise CommandRefused(f"The node cannot be started: {error}") from error
        await self._stop_others()
        node = self._nodes[key] = Node(command, self._on_state)
        task = asyncio.create_task(node.run())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        await self._wait_until(lambda: node.state.phase is not Phase.STARTING, None)
        if node.state.alive:
            self._unreported.append((name, node))
            self._conversation.say(f"Running in ROS domain {self._conversation.session.domain}: {command.typed}")
            self._conversation.say(f"log{which} reads what it writes, stop{which} ends it.")
        else:
            self._conversation.say(f"It could not be started: {node.state.note}")
        return node

    async def log(self, words: list[str]) -> None:
        """Read the last lines of a log; wait a moment for a node that has only just started."""
        of_partner = words[:1] == ["partner"]
        node, rest = (self._latest_partner, words[1:]) if of_partner else (self._latest, words)
        if node is None:
            refused = (
                "No partner has been run yet: say partner." if of_partner else "No node has been run yet: say run."
            )
            raise CommandRefused(refused)
        limit = int(rest[0]) if rest and rest[0].isdecimal() and int(rest[0]) else _DEFAULT_LINES
        await self._wait_until(lambda: bool(node.state.lines) or not node.state.alive, _FIRST_LINE_TIMEOUT_S)
        lines = node.state.lines[-limit:]
        self._conversation.say(
            f"{counted(len(lines), 'line')}, the latest last:" if lines else "It has written nothing yet."
        )
        for line in lines:
            self._conversation.say(one_line(line.text, 500))

    async def stop(self, words: list[str]) -> None:
        """Stop all nodes, or only the partner, and wait until they have ended."""
        if words[:1] == ["partner"]:
            partner = self._latest_partner
            if partner is None or not partner.state.alive:
                raise CommandRefused("No partner is running.")
            await self._end([partner])
            return
        if not self._tasks:
            raise CommandRefused("No node is running.")
        await self.stop_all()
        self.report_ended()

    async def _stop_others(self) -> None:
        """Stop other lessons' nodes, which would publish on the same topics."""
        session, lesson = self._conversation.session, self._conversation.lesson
        kept = {*map(session.path, lesson.files), *(partner.key for partner in lesson.live.partners)}
        await self._end([node for key, node in self._nodes.items() if key not in kept and node.state.alive])

    async def _end(self, nodes: list[Node]) -> None:
        for node in nodes:
            node.stop()
        for node in nodes:
            await node.over.wait()
        self.report_ended()

    def report_ended(self) -> None:
        """Say which nodes have ended since the last report."""
        ended = [(name, node) for name, node in self._unreported if not node.state.alive]
        self._unreported = [(name, node) for name, node in self._unreported if node.state.alive]
        for name, node in ended:
            self._conversation.say(f"{name}: {node.state.note}.")

    async def stop_all(self) -> None:
        """Stop all nodes, and wait until no process of theirs is left."""
        for node in self._nodes.values():
            node.stop()
        if self._tasks:
            await asyncio.wait(set(self._tasks))

    def _on_state(self, state: NodeState) -> None:
        self._changed.set()

    async def _wait_until(self, condition: Callable[[], bool], timeout_s: float | None) -> None:
        try:
            async with asyncio.timeout(timeout_s):
                while not condition():
                    self._changed.clear()
                    await self._changed.wait()
        except TimeoutError:
            return
