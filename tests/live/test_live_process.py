"""The watching process on a real domain: what it counts, and that it never outlives the app."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterator

import pytest

from tests.live.world import METRONOME, World, world
from tutor.live.protocol import Follow, Ready, SetVisible, Update, WatcherRequest, decode_update, encode_request
from tutor.live.updates import TopicUpdate

LIMIT_S = 30.0


class Watching:
    """The child, as a test talks to it."""

    def __init__(self, around: World) -> None:
        command = around.command()
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(
            command.argv, env=dict(command.env), stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, bufsize=0
        )
        self._held = b""

    def tell(self, request: WatcherRequest) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(encode_request(request).encode() + b"\n")

    def updates(self, limit_s: float = LIMIT_S) -> Iterator[Update]:
        assert self.process.stdout is not None
        deadline = time.monotonic() + limit_s
        while select.select([self.process.stdout], [], [], max(0.0, deadline - time.monotonic()))[0]:
            if not (some := os.read(self.process.stdout.fileno(), 1 << 16)):
                return
            *lines, self._held = (self._held + some).split(b"\n")
            for line in lines:
                yield decode_update(line.decode())

    def ready(self) -> None:
        assert any(isinstance(update, Ready) for update in self.updates())

    def close(self) -> None:
        for end in (self.process.stdin, self.process.stdout):
            assert end is not None
            with contextlib.suppress(BrokenPipeError):
                end.close()
        self.process.wait(5)


@pytest.fixture
def around() -> Iterator[World]:
    with world() as made:
        yield made


def test_every_message_of_a_1_khz_topic_is_counted_and_news_of_it_are_few(around: World) -> None:
    watching = Watching(around)
    try:
        watching.tell(Follow("/ticks"))
        watching.ready()
        node = around.run(METRONOME, "1000", "3000")
        last: TopicUpdate | None = None
        began, heard = 0.0, 0
        for update in watching.updates():
            if isinstance(update, TopicUpdate) and update.count:
                began = began or time.monotonic()
                heard, last = heard + 1, update
                if update.count >= 3000:
                    break
        assert last is not None
        assert last.count == 3000
        assert last.lost == 0
        assert heard <= 12 * (time.monotonic() - began) + 3
        assert last.fields == ()  # told once, with the first message
        assert last.timing is not None
        assert last.timing.rate_hz == pytest.approx(1000, rel=0.2)
        assert around.said(node).startswith("3000 ")
    finally:
        watching.close()


def test_where_nobody_looks_it_counts_on_in_silence(around: World) -> None:
    watching = Watching(around)
    try:
        watching.tell(Follow("/ticks"))
        watching.tell(SetVisible(False))
        watching.ready()
        node = around.run(METRONOME, "500", "500")
        assert around.said(node).startswith("500 ")
        watching.tell(SetVisible(True))
        counts = (update.count for update in watching.updates() if isinstance(update, TopicUpdate))
        first = next(count for count in counts if count)
        assert first > 450  # not told before; the last few may still be on their way
        assert first == 500 or next(count for count in counts if count >= 500) == 500
    finally:
        watching.close()


def test_it_ends_when_its_input_ends(around: World) -> None:
    watching = Watching(around)
    watching.ready()
    assert watching.process.stdin is not None
    watching.process.stdin.close()
    assert watching.process.wait(5) == 0
    watching.close()


def test_it_ends_even_before_it_has_begun(around: World) -> None:
    watching = Watching(around)
    assert watching.process.stdin is not None
    watching.process.stdin.close()
    assert watching.process.wait(20) == 0
    watching.close()


def test_a_line_that_is_not_a_command_does_no_harm(around: World) -> None:
    watching = Watching(around)
    try:
        assert watching.process.stdin is not None
        watching.process.stdin.write(b'{"kind": "Dance"}\n\xff\n')
        watching.ready()
        watching.tell(Follow("/ticks"))
        assert any(isinstance(update, TopicUpdate) for update in watching.updates())
    finally:
        watching.close()


# An app that starts the child as the real one does, keeps the pipe's end open elsewhere, and is then killed.
APP = """
import asyncio, os, sys
from tutor.tui.live.child import LiveChild
from tutor.tui.live.launching import watcher_command

async def main():
    child = await LiveChild.start(watcher_command(int(os.environ["ROS_DOMAIN_ID"])))
    async for update in child.updates():
        print(child.pid, flush=True)
        break
    await asyncio.sleep(60)

asyncio.run(main())
"""


def test_it_does_not_outlive_an_app_that_is_killed(around: World) -> None:
    app = subprocess.Popen([sys.executable, "-c", APP], env=around.environ, stdout=subprocess.PIPE)
    assert app.stdout is not None
    pid = int(app.stdout.readline())
    ended = os.pidfd_open(pid)
    try:
        app.send_signal(signal.SIGKILL)
        app.wait(5)
        assert select.select([ended], [], [], 5.0)[0], "the child is still there"
    finally:
        os.close(ended)
        app.stdout.close()
