"""`python -m tutor.live`: watches the user's own domain for as long as stdin is open.

Requests come on stdin and updates go to stdout, as one JSON object per line (`tutor.live.protocol`).
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from typing import BinaryIO

from tutor.interpreter import reduce_gc_frequency
from tutor.live.protocol import Update, decode_request, encode_update
from tutor.live.request_reader import read_lines
from tutor.live.updates import TopicUpdate
from tutor.process.prctl import die_with_parent
from tutor.ros.environment import detect
from tutor.ros.process_setup import prepare_for_rclpy

MAX_UNREAD_BYTES = 1 << 20
"""With more than this many bytes unread, topic updates are dropped, since later ones supersede them."""


def main() -> int:
    """Watch until stdin ends. Exit code 0."""
    reduce_gc_frequency()
    prepare_for_rclpy(detect(), isolated=False)
    die_with_parent()
    # Anything that libraries print must not get mixed into the updates.
    updates_pipe = os.fdopen(os.dup(sys.stdout.fileno()), "wb", buffering=0)
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    asyncio.run(_watch(updates_pipe))
    # Do not wait for middleware threads: there is nothing left to save.
    sys.stderr.flush()
    os._exit(0)


async def _watch(pipe: BinaryIO) -> None:
    from tutor.live.watcher import Watcher  # imported late: rclpy needs the prepared environment

    loop = asyncio.get_running_loop()
    transport, _ = await loop.connect_write_pipe(asyncio.BaseProtocol, pipe)

    def send(update: Update) -> None:
        if not (isinstance(update, TopicUpdate) and transport.get_write_buffer_size() > MAX_UNREAD_BYTES):
            transport.write(encode_update(update).encode() + b"\n")

    watcher = Watcher(_domain_id(), send)
    running = asyncio.ensure_future(watcher.run())

    def receive(line: str) -> None:
        loop.call_soon_threadsafe(lambda: watcher.handle(decode_request(line)))

    def stop() -> None:
        with contextlib.suppress(RuntimeError):  # the loop is already closed
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
