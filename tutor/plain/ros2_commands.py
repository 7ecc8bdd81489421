"""Commands that run `ros2`: messages, parameters, services and topics, as lines."""

from __future__ import annotations

import asyncio
import shlex
from collections.abc import Callable, Sequence

from tutor.errors import CommandError, CommandRefused
from tutor.judge.trace import OutputLine
from tutor.judge.wording import counted
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.report.plain import one_line
from tutor.session.node import Node

_TIMEOUT_S = 10.0
"""Timeout of a `ros2` command, in seconds."""

_DEFAULT_MESSAGES = 3
_END_OF_MESSAGE = "---"


class Ros2Commands:
    """Runs `ros2` in the learner's ROS domain, and says what it prints."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self.commands = (
            DialogCommand(
                "echo",
                f"read the next {_DEFAULT_MESSAGES} messages on a topic, or NUMBER of them",
                self.echo,
                "TOPIC [NUMBER]",
            ),
            DialogCommand(
                "param", "get or set a parameter, as in: param set /node rate 2.0", self.param, "list|get|set ..."
            ),
            DialogCommand(
                "service",
                "list or call services, as in: service call /add example_interfaces/srv/AddTwoInts '{a: 1, b: 2}'",
                self.service,
                "list|type|call ...",
            ),
            DialogCommand(
                "topic", "list topics, or describe one, as in: topic info /chatter", self.topic, "list|info ..."
            ),
        )

    async def echo(self, words: list[str]) -> None:
        """Read some messages."""
        if not words:
            raise CommandRefused("Which topic? As in: echo /chatter. topic list lists them.")
        wanted = int(words[1]) if words[1:] and words[1].isdecimal() and int(words[1]) else _DEFAULT_MESSAGES

        def enough(lines: Sequence[OutputLine]) -> bool:
            return sum(line.text == _END_OF_MESSAGE for line in lines) >= wanted

        deadline = asyncio.get_running_loop().time() + _TIMEOUT_S
        lines = await self._run(["topic", "echo", words[0]], enough, _TIMEOUT_S)
        while _is_unpublished(lines) and (remaining_s := deadline - asyncio.get_running_loop().time()) > 0:
            # The node may have only just started.
            lines = await self._run(["topic", "echo", words[0]], enough, remaining_s)
        count = 0
        for line in lines:
            count += line.text == _END_OF_MESSAGE
            if count == wanted:
                break
            if line.text != _END_OF_MESSAGE:
                self._conversation.say(one_line(line.text, 500))
        if count < wanted:
            self._conversation.say(f"{counted(count, 'message')} in {_TIMEOUT_S:.0f} seconds on {words[0]}.")

    async def param(self, words: list[str]) -> None:
        """Run `ros2 param`."""
        await self._run_verb("param", words)

    async def service(self, words: list[str]) -> None:
        """Run `ros2 service`."""
        await self._run_verb("service", words)

    async def topic(self, words: list[str]) -> None:
        """Run `ros2 topic`."""
        await self._run_verb("topic", words)

    async def _run_verb(self, name: str, words: list[str]) -> None:
        try:
            arguments = shlex.split(" ".join(words))
        except ValueError as error:
            raise CommandRefused("A quotation mark is missing.") from error
        lines = await self._run([name, *(arguments or ["list"])], lambda lines: False, _TIMEOUT_S)
        for line in lines:
            if line.text.strip():
                self._conversation.say(one_line(line.text, 500))
        if not lines:
            self._conversation.say("Nothing was printed.")

    async def _run(
        self, words: Sequence[str], enough: Callable[[Sequence[OutputLine]], bool], timeout_s: float
    ) -> list[OutputLine]:
        """Run `ros2` until it ends, has printed enough, or times out."""
        try:
            command = await asyncio.to_thread(self._conversation.session.ros2_command, words)
        except (CommandError, OSError) as error:
            raise CommandRefused(f"ros2 cannot be run: {error}") from error
        changed = asyncio.Event()
        node = Node(command, lambda state: changed.set())
        running = asyncio.create_task(node.run())
        try:
            async with asyncio.timeout(timeout_s):
                while node.state.alive and not enough(node.state.lines):
                    await changed.wait()
                    changed.clear()
        except TimeoutError:
            self._conversation.say(f"ros2 {words[0]} was stopped after {_TIMEOUT_S:.0f} seconds.")
        finally:
            node.stop()
            await running
        return list(node.state.lines)


def _is_unpublished(lines: Sequence[OutputLine]) -> bool:
    return any("does not appear to be published yet" in line.text for line in lines) and not any(
        line.text == _END_OF_MESSAGE for line in lines
    )
