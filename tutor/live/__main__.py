"""`python -m tutor.live`: watches the user's own domain, for as long as its input is open.

Requests come on stdin, updates go to stdout, a JSON object to a line each (`tutor.live.protocol`).
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from typing import BinaryIO

from tutor.interpreter import collect_garbage_seldom
from tutor.live.protocol import Update, decode_request, encode_update
from tutor.live.request_reader import read_lines
from tutor.live.updates import TopicUpdate
from tutor.process.prctl import die_with_parent
from tutor.ros.environment import detect
from tutor.ros.process_setup import prepare_for_rclpy

FULL = 1 << 20
"""With this many bytes unread, topic updates are dropped: the next ones supersede them."""


def main() -> int:
    """Watch until stdin ends. Exit code 0."""
    collect_garbage_seldom()
    prepare_for_rclpy(detect(), isolated=False)
    die_with_parent()
    # What libraries print must not get among the updates.
    pipe_file = os.fdopen(os.dup(sys.stdout.fileno()), "wb", buffering=0)
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    asyncio.run(_watch(pipe_file))
    # Threads of the middleware may take their time; we have nothing left to save.
    sys.stderr.flush()
    os._exit(0)


async def _watch(pipe: BinaryIO) -> None:
    from tutor.live.watcher import Watcher  # late: rclpy must find the environment prepared

    loop = asyncio.get_running_loop()
    transport, _ = await loop.connect_write_pipe(asyncio.BaseProtocol, pipe)

    def send(update: Update) -> None:
        if not (isinstance(update, TopicUpdate) and transport.get_write_buffer_size() > FULL):
            transport.write(encode_update(update).encode() + b"\n")

    watcher = Watcher(_domain_id(), send)
    running = asyncio.ensure_future(watcher.run())

    def receive(line: str) -> None:
        loop.call_soon_threadsafe(lambda: watcher.handle(decode_request(line)))

    def stop() -> None:
        with contextlib.suppress(RuntimeError):  # the loop is closed: it is over already
            loop.call_soon_threadsafe(running.cancel)

    read_lines(sys.stdin.buffer, receive, stop)
    try:
        await running
    except asyncio.CancelledError:
        pass
    finally:
        watcher.close()


def _domain_id() -> int:
    text = os.environ.get("ROS_DOMAIN_ID", "").strip()
    return int(text) if text.isdecimal() else 0


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):
        sys.exit(main())
