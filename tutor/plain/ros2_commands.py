"""What the nodes do, asked by the `ros2` command: messages, parameters and services, as lines."""

from __future__ import annotations

import asyncio
import shlex
from collections.abc import Callable, Sequence

from tutor.errors import CommandError, CommandRefused
from tutor.judge.trace import OutputLine
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.plain.speech import counted
from tutor.report.plain import one_line
from tutor.session.node import Node

LIMIT_S = 10.0
"""How long a command may go on before it is stopped, in seconds."""

_MESSAGES = 3
_END_OF_MESSAGE = "---"


class Ros2Commands:
    """Runs `ros2` in the learner's ROS domain, and says what it printed."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self.commands = (
            DialogCommand(
                "echo", f"read the next {_MESSAGES} messages on a topic, or NUMBER of them", self.echo, "TOPIC [NUMBER]"
            ),
            DialogCommand(
                "param", "ask for or set a parameter, as in: param set /node rate 2.0", self.param, "list|get|set ..."
            ),
            DialogCommand(
                "service",
                "list or call services, as in: service call /add example_interfaces/srv/AddTwoInts '{a: 1, b: 2}'",
                self.service,
                "list|type|call ...",
            ),
            DialogCommand("topic", "list topics, or say more, as in: topic info /chatter", self.topic, "list|info ..."),
        )

    async def echo(self, words: list[str]) -> None:
        """Read some messages, then stop."""
        if not words:
            raise CommandRefused("Which topic? As in: echo /chatter. topic list lists them.")
        number = int(words[1]) if words[1:] and words[1].isdecimal() and int(words[1]) else _MESSAGES

        def enough(lines: Sequence[OutputLine]) -> bool:
            return sum(line.text == _END_OF_MESSAGE for line in lines) >= number

        until = asyncio.get_running_loop().time() + LIMIT_S
        lines = await self._run(["topic", "echo", words[0]], enough, LIMIT_S)
        while _not_there_yet(lines) and (left := until - asyncio.get_running_loop().time()) > 0:
            lines = await self._run(["topic", "echo", words[0]], enough, left)  # a node that was just started
        message = 0
        for line in lines:
            message += line.text == _END_OF_MESSAGE
            if message == number:
                break
            if line.text != _END_OF_MESSAGE:
                self._conversation.say(one_line(line.text, 500))
        if message < number:
            self._conversation.say(f"{counted(message, 'message')} in {LIMIT_S:.0f} seconds on {words[0]}.")

    async def param(self, words: list[str]) -> None:
        """What `ros2 param` does."""
        await self._hand_on("param", words)

    async def service(self, words: list[str]) -> None:
        """What `ros2 service` does."""
        await self._hand_on("service", words)

    async def topic(self, words: list[str]) -> None:
        """What `ros2 topic` does."""
        await self._hand_on("topic", words)

    async def _hand_on(self, name: str, words: list[str]) -> None:
        try:
            given = shlex.split(" ".join(words))
        except ValueError as error:
            raise CommandRefused("A quotation mark is missing.") from error
        lines = await self._run([name, *(given or ["list"])], lambda lines: False, LIMIT_S)
        for line in lines:
            if line.text.strip():
                self._conversation.say(one_line(line.text, 500))
        if not lines:
            self._conversation.say("Nothing was printed.")

    async def _run(
        self, words: Sequence[str], enough: Callable[[Sequence[OutputLine]], bool], limit_s: float
    ) -> list[OutputLine]:
        """Run it until it ends, until it has printed enough, or until its time is over."""
        try:
            command = await asyncio.to_thread(self._conversation.session.ros2_command, words)
        except (CommandError, OSError) as error:
            raise CommandRefused(f"ros2 cannot be run: {error}") from error
        changed = asyncio.Event()
        node = Node(command, lambda state: changed.set())
        running = asyncio.create_task(node.run())
        try:
            async with asyncio.timeout(limit_s):
                while node.state.alive and not enough(node.state.lines):
                    await changed.wait()
                    changed.clear()
        except TimeoutError:
            self._conversation.say(f"ros2 {words[0]} was stopped after {LIMIT_S:.0f} seconds.")
        finally:
            node.stop()
            await running
        return list(node.state.lines)


def _not_there_yet(lines: Sequence[OutputLine]) -> bool:
    return any("does not appear to be published yet" in line.text for line in lines) and not any(
        line.text == _END_OF_MESSAGE for line in lines
    )
