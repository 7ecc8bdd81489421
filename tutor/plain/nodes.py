"""The learner's node, run in their own ROS domain while they go on talking with us."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from tutor.errors import CommandError, CommandRefused
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.plain.speech import counted
from tutor.report.plain import one_line
from tutor.session.node import Node, NodeState, Phase

FIRST_LINE_S = 5.0
"""How long `log` waits for a node to say something at all, in seconds."""

_LINES = 10


class Nodes:
    """One node for each file. What has ended is reported once, before the next question."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self._nodes: dict[Path, Node] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._latest: Node | None = None
        self._untold: list[Node] = []
        self._changed = asyncio.Event()
        self.commands = (
            DialogCommand("run", "run your node; with a number, that file of the lesson", self.run, "[NUMBER]"),
            DialogCommand(
                "log", f"read the last {_LINES} lines that your node wrote, or NUMBER of them", self.log, "[NUMBER]"
            ),
            DialogCommand("stop", "stop your node, as Ctrl+C does", self.stop),
        )

    async def run(self, words: list[str]) -> None:
        """Run a file of the lesson with the options that the app remembers."""
        session, lesson = self._conversation.session, self._conversation.lesson
        number = int(words[0]) if words and words[0].isdecimal() else 1
        if not 1 <= number <= len(lesson.files):
            raise CommandRefused(f"This lesson has {counted(len(lesson.files), 'file')}.")
        file = lesson.files[number - 1]
        path = session.path(file)
        if not path.exists():
            raise CommandRefused(f"{file.name} is not in your workspace yet: say start.")
        known = self._nodes.get(path)
        if known is not None and known.state.alive:
            raise CommandRefused(f"{file.name} runs already: stop ends it.")
        try:
            command = await asyncio.to_thread(session.node_command, file, session.app_state().run_of(lesson.id))
        except (CommandError, OSError) as error:
            raise CommandRefused(f"The node cannot be started: {error}") from error
        await self._stop_others({session.path(each) for each in lesson.files})
        node = Node(command, self._show)
        self._nodes[path] = self._latest = node
        task = asyncio.create_task(node.run())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        await self._until(lambda: node.state.phase is not Phase.STARTING, None)
        if node.state.alive:
            self._untold.append(node)
            self._conversation.say(f"Running in ROS domain {self._conversation.session.domain}: {command.typed}")
            self._conversation.say("log reads what it writes, stop ends it.")
        else:
            self._conversation.say(f"It could not be started: {node.state.note}")

    async def log(self, words: list[str]) -> None:
        """Read what was written last; a node that has just been started is given a moment."""
        node = self._latest
        if node is None:
            raise CommandRefused("No node has been run yet: say run.")
        most = int(words[0]) if words and words[0].isdecimal() and int(words[0]) else _LINES
        await self._until(lambda: bool(node.state.lines) or not node.state.alive, FIRST_LINE_S)
        lines = node.state.lines[-most:]
        self._conversation.say(
            f"{counted(len(lines), 'line')}, the latest last:" if lines else "It has written nothing yet."
        )
        for line in lines:
            self._conversation.say(one_line(line.text, 500))

    async def stop(self, words: list[str]) -> None:
        """Stop whatever runs, and wait until it has."""
        if not self._tasks:
            raise CommandRefused("No node is running.")
        await self.leave()
        self.report_ended()

    async def _stop_others(self, own: set[Path]) -> None:
        """Two lessons' nodes would talk into each other's topics."""
        others = [node for path, node in self._nodes.items() if path not in own and node.state.alive]
        for node in others:
            node.stop()
        for node in others:
            await node.over.wait()
        self.report_ended()

    def report_ended(self) -> None:
        """Say which nodes have ended since this was last said."""
        for node in [node for node in self._untold if not node.state.alive]:
            self._untold.remove(node)
            self._conversation.say(f"Your node {node.state.file}: {node.state.note}.")

    async def leave(self) -> None:
        """Stop all of them; nothing of them is left then."""
        for node in self._nodes.values():
            node.stop()
        if self._tasks:
            await asyncio.wait(set(self._tasks))

    def _show(self, state: NodeState) -> None:
        self._changed.set()

    async def _until(self, seen: Callable[[], bool], limit_s: float | None) -> None:
        try:
            async with asyncio.timeout(limit_s):
                while not seen():
                    self._changed.clear()
                    await self._changed.wait()
        except TimeoutError:
            return
