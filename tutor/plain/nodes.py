"""Commands to run, read and stop the learner's node, in their own ROS domain, while the dialog goes on."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from tutor.errors import CommandError, CommandRefused
from tutor.judge.wording import counted
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.report.plain import one_line
from tutor.session.node import Node, NodeState, Phase

_FIRST_LINE_TIMEOUT_S = 5.0
"""How long `log` waits for a node's first line, in seconds."""

_DEFAULT_LINES = 10


class Nodes:
    """At most one node per file. The end of a node is reported once, before the next prompt."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self._nodes: dict[Path, Node] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._latest: Node | None = None
        self._unreported: list[Node] = []
        self._changed = asyncio.Event()
        self.commands = (
            DialogCommand("run", "run your node; with a number, that file of the lesson", self.run, "[NUMBER]"),
            DialogCommand(
                "log",
                f"read the last {_DEFAULT_LINES} lines that your node wrote, or NUMBER of them",
                self.log,
                "[NUMBER]",
            ),
            DialogCommand("stop", "stop your node, as Ctrl+C does", self.stop),
        )

    async def run(self, words: list[str]) -> None:
        """Run a file of the lesson with the run options saved in the app."""
        session, lesson = self._conversation.session, self._conversation.lesson
        number = int(words[0]) if words and words[0].isdecimal() else 1
        if not 1 <= number <= len(lesson.files):
            raise CommandRefused(f"This lesson has {counted(len(lesson.files), 'file')}.")
        file = lesson.files[number - 1]
        path = session.path(file)
        if not path.exists():
            raise CommandRefused(f"{file.name} is not in your workspace yet: say start.")
        previous = self._nodes.get(path)
        if previous is not None and previous.state.alive:
            raise CommandRefused(f"{file.name} is already running: stop ends it.")
        try:
            command = await asyncio.to_thread(session.node_command, file, session.app_state().run_of(lesson.id))
        except (CommandError, OSError) as error:
            raise CommandRefused(f"The node cannot be started: {error}") from error
        await self._stop_others({session.path(lesson_file) for lesson_file in lesson.files})
        node = Node(command, self._on_state)
        self._nodes[path] = self._latest = node
        task = asyncio.create_task(node.run())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        await self._wait_until(lambda: node.state.phase is not Phase.STARTING, None)
        if node.state.alive:
            self._unreported.append(node)
            self._conversation.say(f"Running in ROS domain {self._conversation.session.domain}: {command.typed}")
            self._conversation.say("log reads what it writes, stop ends it.")
        else:
            self._conversation.say(f"It could not be started: {node.state.note}")

    async def log(self, words: list[str]) -> None:
        """Read the last lines of the log; wait a moment for a node that has only just started."""
        node = self._latest
        if node is None:
            raise CommandRefused("No node has been run yet: say run.")
        limit = int(words[0]) if words and words[0].isdecimal() and int(words[0]) else _DEFAULT_LINES
        await self._wait_until(lambda: bool(node.state.lines) or not node.state.alive, _FIRST_LINE_TIMEOUT_S)
        lines = node.state.lines[-limit:]
        self._conversation.say(
            f"{counted(len(lines), 'line')}, the latest last:" if lines else "It has written nothing yet."
        )
        for line in lines:
            self._conversation.say(one_line(line.text, 500))

    async def stop(self, words: list[str]) -> None:
        """Stop all nodes, and wait until they have ended."""
        if not self._tasks:
            raise CommandRefused("No node is running.")
        await self.stop_all()
        self.report_ended()

    async def _stop_others(self, kept: set[Path]) -> None:
        """Stop other lessons' nodes, which would publish on the same topics."""
        others = [node for path, node in self._nodes.items() if path not in kept and node.state.alive]
        for node in others:
            node.stop()
        for node in others:
            await node.over.wait()
        self.report_ended()

    def report_ended(self) -> None:
        """Say which nodes have ended since the last report."""
        for node in [node for node in self._unreported if not node.state.alive]:
            self._unreported.remove(node)
            self._conversation.say(f"Your node {node.state.file}: {node.state.note}.")

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
