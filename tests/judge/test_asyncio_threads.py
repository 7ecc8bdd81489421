"""asyncio and rclpy in two threads: what must wake the event loop."""

from __future__ import annotations

import pytest

from tutor.judge.causes.asyncio_threads import diagnose_other_threads_wake_up
from tutor.judge.rewriting.node import node_file

WAIT = """\
import asyncio


async def wait_for(future):
    done = {made}
    future.add_done_callback(lambda f: {wake})
    await done
"""


@pytest.mark.parametrize(
    ("made", "wake", "becomes"),
    [
        ("asyncio.Event()", "done.set()", "loop.call_soon_threadsafe(done.set)"),
        (
            "asyncio.get_event_loop().create_future()",
            "done.set_result(f.result())",
            "loop.call_soon_threadsafe(done.set_result, f.result())",
        ),
        ("asyncio.Future()", "done.set_result(7)", "loop.call_soon_threadsafe(done.set_result, 7)"),
        ("threading.Event()", "done.set()", None),
        ("rclpy.task.Future()", "done.set_result(7)", None),
        ("asyncio.Event()", "print('done')", None),
    ],
)
def test_a_done_callback_wakes_the_event_loop_from_its_own_thread(made: str, wake: str, becomes: str | None) -> None:
    found = diagnose_other_threads_wake_up(node_file(WAIT.format(made=made, wake=wake)))
    if becomes is None:
        assert found is None
    else:
        assert found is not None
        given = f"lambda f, loop=asyncio.get_running_loop(): {becomes}"
        assert found.hint == f"line 6 becomes: future.add_done_callback({given})"
