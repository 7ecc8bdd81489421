"""The watcher process on a real domain: what it counts, and that it never outlives the app."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.live.private_domain import METRONOME, PrivateDomain, private_domain
from tutor.live.protocol import Follow, Ready, SetVisible, Update, WatcherRequest, decode_update, encode_request
from tutor.live.updates import NodeParameters, TopicUpdate
from tutor.ros_model import Graph

LIMIT_S = 30.0


class Watcher:
    """A watcher process, with its requests and updates."""

    def __init__(self, ros_world: PrivateDomain) -> None:
        command = ros_world.command()
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(
            command.argv, env=dict(command.env), stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, bufsize=0
        )
        self._unfinished = b""

    def send(self, request: WatcherRequest) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(encode_request(request).encode() + b"\n")

    def updates(self, limit_s: float = LIMIT_S) -> Iterator[Update]:
        assert self.process.stdout is not None
        deadline = time.monotonic() + limit_s
        while select.select([self.process.stdout], [], [], max(0.0, deadline - time.monotonic()))[0]:
            if not (chunk := os.read(self.process.stdout.fileno(), 1 << 16)):
                return
            *lines, self._unfinished = (self._unfinished + chunk).split(b"\n")
            for line in lines:
                yield decode_update(line.decode())

    def wait_until_ready(self) -> None:
        assert any(isinstance(update, Ready) for update in self.updates())

    def close(self) -> None:
        for stream in (self.process.stdin, self.process.stdout):
            assert stream is not None
            with contextlib.suppress(BrokenPipeError):
                stream.close()
        self.process.wait(5)


@pytest.fixture
def ros_world() -> Iterator[PrivateDomain]:
    with private_domain() as private:
        yield private


def test_every_message_of_a_1_khz_topic_is_counted_with_few_updates(ros_world: PrivateDomain) -> None:
    watcher = Watcher(ros_world)
    try:
        watcher.send(Follow("/ticks"))
        watcher.wait_until_ready()
        node = ros_world.run(METRONOME, "1000", "3000")
        last: TopicUpdate | None = None
        began, received = 0.0, 0
        for update in watcher.updates():
            if isinstance(update, TopicUpdate) and update.count:
                began = began or time.monotonic()
                received, last = received + 1, update
                if update.count >= 3000:
                    break
        assert last is not None
        assert last.count == 3000
        assert last.lost == 0
        assert received <= 12 * (time.monotonic() - began) + 3
        assert last.fields == ()  # sent once, with the first message
        assert last.timing is not None
        assert last.timing.rate_hz == pytest.approx(1000, rel=0.2)
        assert ros_world.read_line(node).startswith("3000 ")
    finally:
        watcher.close()


NUMBERED = """\
import sys
import rclpy
from rclpy.node import Node

rclpy.init()
node = Node('numbered')
node.declare_parameter('number', int(sys.argv[1]))
print('ready', flush=True)
rclpy.spin(node)
"""


def test_a_node_that_replaces_another_of_its_name_has_its_parameters_read(
    ros_world: PrivateDomain, tmp_path: Path
) -> None:
    program = tmp_path / "numbered.py"
    program.write_text(NUMBERED)
    watcher = Watcher(ros_world)

    def wait_for(number: int) -> None:
        values = (
            {each.name: each.value for each in update.parameters}
            for update in watcher.updates()
            if isinstance(update, NodeParameters) and update.node == "/numbered"
        )
        assert any(each.get("number") == number for each in values)

    try:
        watcher.wait_until_ready()
        first = ros_world.run(program, "1")
        wait_for(1)
        ros_world.run(program, "2")
        graphs = (update for update in watcher.updates() if isinstance(update, Graph))
        assert any(graph.nodes.count("/numbered") == 2 for graph in graphs)
        ros_world.interrupt(first)
        wait_for(2)
    finally:
        watcher.close()


def test_while_hidden_it_counts_without_sending_updates(ros_world: PrivateDomain) -> None:
    watcher = Watcher(ros_world)
    try:
        watcher.send(Follow("/ticks"))
        watcher.send(SetVisible(False))
        watcher.wait_until_ready()
        node = ros_world.run(METRONOME, "500", "500")
        assert ros_world.read_line(node).startswith("500 ")
        watcher.send(SetVisible(True))
        counts = (update.count for update in watcher.updates() if isinstance(update, TopicUpdate))
        first = next(count for count in counts if count)
        assert first > 450  # no update before; the last few messages may still be in flight
        assert first == 500 or next(count for count in counts if count >= 500) == 500
    finally:
        watcher.close()


def test_the_watcher_ends_when_its_stdin_closes(ros_world: PrivateDomain) -> None:
    watcher = Watcher(ros_world)
    watcher.wait_until_ready()
    assert watcher.process.stdin is not None
    watcher.process.stdin.close()
    assert watcher.process.wait(5) == 0
    watcher.close()


def test_the_watcher_ends_even_if_its_stdin_closes_before_it_is_ready(ros_world: PrivateDomain) -> None:
    watcher = Watcher(ros_world)
    assert watcher.process.stdin is not None
    watcher.process.stdin.close()
    assert watcher.process.wait(20) == 0
    watcher.close()


def test_an_invalid_request_line_is_ignored(ros_world: PrivateDomain) -> None:
    watcher = Watcher(ros_world)
    try:
        assert watcher.process.stdin is not None
        watcher.process.stdin.write(b'{"kind": "Dance"}\n\xff\n')
        watcher.wait_until_ready()
        watcher.send(Follow("/ticks"))
        assert any(isinstance(update, TopicUpdate) for update in watcher.updates())
    finally:
        watcher.close()


# Starts the watcher as the real app does, prints its pid, and is then killed.
APP = """
import asyncio, os, sys
from tutor.tui.live.watcher import LiveChild, watcher_command

async def main():
    child = await LiveChild.start(watcher_command(int(os.environ["ROS_DOMAIN_ID"])))
    async for update in child.updates():
        print(child.pid, flush=True)
        break
    await asyncio.sleep(60)

asyncio.run(main())
"""


def test_the_watcher_does_not_outlive_a_killed_app(ros_world: PrivateDomain) -> None:
    app = subprocess.Popen([sys.executable, "-c", APP], env=ros_world.environ, stdout=subprocess.PIPE)
    assert app.stdout is not None
    pid = int(app.stdout.readline())
    ended = os.pidfd_open(pid)
    try:
        app.send_signal(signal.SIGKILL)
        app.wait(5)
        assert select.select([ended], [], [], 5.0)[0], "the watcher is still running"
    finally:
        os.close(ended)
        app.stdout.close()
