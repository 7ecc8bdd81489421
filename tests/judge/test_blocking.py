"""A node that no longer answers: where a callback blocks, and the step that unblocks it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.checks.builders import FOLDER, lines, trace
from tutor.judge.causes import diagnose_blocked, use_threads
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame, dumped_frames, frames_by_thread


def node(*body: str) -> Trace:
    """A run of a node whose file has these lines."""
    return replace(trace(), sources={"node.py": "\n".join(body)})


def own_frame(line: int, code: str, function: str = "tick", thread: int = 1) -> Frame:
    return Frame(f"{FOLDER}/node.py", line, function, code, thread)


def rclpy_frame(function: str, file: str = "executors", thread: int = 1) -> Frame:
    return Frame(f"/lib/rclpy/{file}.py", 90, function, "", thread)


WORKER = (rclpy_frame("await_or_execute"), Frame("/lib/concurrent/futures/thread.py", 58, "run", "", 1))
MAIN = (rclpy_frame("spin", thread=2), own_frame(42, "executor.spin()", "main", 2))


@pytest.mark.parametrize(
    ("seen", "stuck", "cause", "words", "step"),
    [
        (
            node("x", "self.cli = self.create_client(AddTwoInts, 'add')"),
            (rclpy_frame("call", "client"), own_frame(31, "response = self.cli.call(request)"), *WORKER, *MAIN),
            "deadlock by call()",
            "line 31",
            "line 31 becomes: response = await self.cli.call_async(request) (with async in front of def tick(...)); "
            "give line 2 callback_group=self.group, with",
        ),
        (
            node("self.cli = self.create_client(A, 'add')", "executor = MultiThreadedExecutor()"),
            (rclpy_frame("call", "client"), own_frame(31, "response = self.cli.call(request)"), *WORKER, *MAIN),
            "deadlock by call()",
            "line 31",
            "give line 1 callback_group=self.group",
        ),
        (
            node("g = MutuallyExclusiveCallbackGroup()", "self.create_client(A, 'add', callback_group=g)"),
            (rclpy_frame("spin_once"), own_frame(9, "rclpy.spin_until_future_complete(self, future)"), *WORKER, *MAIN),
            "blocked executor",
            "line 9",
            "line 9 becomes: await future (with async in front of def tick(...)); write ReentrantCallbackGroup() in "
            "place of MutuallyExclusiveCallbackGroup() in line 1",
        ),
        (
            node(),
            (rclpy_frame("spin_once"), own_frame(9, "rclpy.spin_once(self)"), *WORKER, *MAIN),
            "blocked executor",
            "line 9",
            "delete line 9",
        ),
        (
            node("self.lock = threading.Lock()"),
            (own_frame(8, "with self.lock:"), *WORKER, *MAIN),
            "blocked executor",
            "waits for self.lock",
            "threading.RLock() in place of threading.Lock() in line 1",
        ),
        (
            node("self.lock = threading.Lock()"),
            (
                own_frame(20, "time.sleep(3.0)", thread=3),
                rclpy_frame("await_or_execute", thread=3),
                own_frame(8, "with self.lock:"),
                *WORKER,
                *MAIN,
            ),
            "blocked executor",
            "another one holds at node.py, line 20",
            "take line 20 out of the lock",
        ),
        (
            node(
                *("def locked(method):", "  def wrapper(self, *args):", "    with self.lock:"),
                *("      return method(self, *args)", "  return wrapper"),
                *("class N(Node):", "  @locked", "  def add(self, req, resp):", "    time.sleep(3.0)"),
            ),
            (
                own_frame(9, "time.sleep(3.0)", "add", thread=3),
                rclpy_frame("await_or_execute", thread=3),
                own_frame(3, "with self.lock:", "wrapper"),
                *WORKER,
                *MAIN,
            ),
            "blocked executor",
            "another one holds at node.py, line 9",
            "remove line 7: @locked",
        ),
        (
            node("while not future.done():", "    time.sleep(0.1)"),
            (own_frame(2, "time.sleep(0.1)"), *WORKER, *MAIN),
            "blocked executor",
            "line 2",
            "write await future in place of the loop",
        ),
        (
            node("rclpy.spin(node)"),
            (Frame("/lib/threading.py", 3, "wait", "", 1), own_frame(8, "self.event.wait()"), *WORKER, *MAIN),
            "blocked executor",
            "line 8",
            "in place of line 1, rclpy.spin(node): executor = MultiThreadedExecutor(num_threads=4); "
            "executor.add_node(node); executor.spin()",
        ),
        (node(), (own_frame(8, "while True:"), *WORKER, *MAIN), "blocked executor", "line 8", "one iteration"),
        (
            node("class N(Node):", "  def tick(self):", "    rclpy.spin_until_future_complete(self, future)"),
            MAIN,
            "blocked executor",
            "line 3, rclpy.spin_until_future_complete(self, future), spins the node within one of its own callbacks",
            "line 3 becomes: await future\nline 2 becomes: async def tick(self):",
        ),
        (
            node("async def add(self, req, resp):", "  other = await self.cli.call_async(req)"),
            MAIN,
            "deadlock by await",
            "line 2: await self.cli.call_async(req)",
            "callback_group=self.group",
        ),
        (node("x = 1"), MAIN, "blocked executor", "never returns;", "let every callback return"),
    ],
)
def test_causes_of_a_blocked_node(seen: Trace, stuck: tuple[Frame, ...], cause: str, words: str, step: str) -> None:
    found = diagnose_blocked(seen, stuck, spins=True)
    assert found is not None
    assert found.name == cause
    assert words in found.text
    assert "line 42" not in found.text  # main() is where it should be
    assert step in found.hint


def test_a_callback_that_awaits_blocks_a_node_that_spins_even_if_it_has_answered_nothing_yet() -> None:
    awaits = node("async def tick(self):", "  value = await self.sensor.read()")
    found = diagnose_blocked(awaits, MAIN, spins=False)
    assert found is not None
    assert found.name == "deadlock by await"
    assert diagnose_blocked(awaits, (own_frame(42, "loop.run_forever()", "main"),), spins=False) is None
    assert diagnose_blocked(node("x = 1"), MAIN, spins=False) is None


NODE = """\
import rclpy
from threading import Lock


class Node(rclpy.node.Node):
    def __init__(self):
        self.lock = Lock()
        self.cli = self.create_client(Add, 'add')

    def tick(self):
        {body}
"""


def full_node(*body: str) -> Trace:
    return replace(trace(), sources={"node.py": NODE.format(body="\n        ".join(body))})


@pytest.mark.parametrize(
    ("body", "stuck", "steps"),
    [
        (
            ["r = self.cli.call(Add.Request())"],
            (rclpy_frame("call", "client"), own_frame(11, "r = self.cli.call(Add.Request())")),
            (
                "line 11 becomes: r = await self.cli.call_async(Add.Request())",
                "line 10 becomes: async def tick(self):",
                "self.cli = self.create_client(Add, 'add', callback_group=ReentrantCallbackGroup())",
                "at the top of the file: from rclpy.callback_groups import ReentrantCallbackGroup",
            ),
        ),
        (
            ["while not future.done():", "    time.sleep(0.1)"],
            (own_frame(12, "time.sleep(0.1)"),),
            ("lines 11 to 12 become: await future", "line 10 becomes: async def tick(self):"),
        ),
        (
            ["rclpy.spin_once(self)"],
            (rclpy_frame("spin_once"), own_frame(11, "rclpy.spin_once(self)")),
            ("line 11 becomes: pass",),
        ),
        (
            ["while True:", "    self.publish()", "    time.sleep(1)"],
            (own_frame(13, "time.sleep(1)"),),
            ("lines 11 to 13 become: self.publish()",),
        ),
        (
            ["with self.lock:", "    time.sleep(3.0)"],
            (
                own_frame(12, "time.sleep(3.0)", thread=3),
                rclpy_frame("await_or_execute", thread=3),
                own_frame(11, "with self.lock:"),
            ),
            ("lines 11 to 12 become: time.sleep(3.0)",),
        ),
        (
            ["with self.lock:", "    self.other()"],
            (own_frame(11, "with self.lock:"),),
            ("line 2 becomes: from threading import RLock", "line 7 becomes: self.lock = RLock()"),
        ),
    ],
)
def test_steps_give_the_lines_to_write(body: list[str], stuck: tuple[Frame, ...], steps: tuple[str, ...]) -> None:
    found = diagnose_blocked(full_node(*body), (*stuck, *WORKER, *MAIN), spins=True)
    assert found is not None
    for each in steps:
        assert each in found.hint


def test_an_attribute_of_the_response_is_read_after_the_await() -> None:
    code = "r.sum = c.call(AddTwoInts.Request(a=q.a, b=-q.b)).sum"
    found = diagnose_blocked(node(), (rclpy_frame("call", "client"), own_frame(3, code), *WORKER))
    assert found is not None
    assert "r.sum = (await c.call_async(AddTwoInts.Request(a=q.a, b=-q.b))).sum" in found.hint


def test_a_node_that_was_never_seen_to_spin_is_not_blocked() -> None:
    assert diagnose_blocked(node("x = 1"), MAIN) is None


def test_steps_do_not_ask_for_code_that_is_already_there() -> None:
    seen = node("executor = MultiThreadedExecutor(num_threads=4)", "rclpy.spin(node)")
    assert use_threads(seen) == "write executor.spin() in place of line 2, rclpy.spin(node)"
    everything = node("g = ReentrantCallbackGroup()", "self.create_client(A, 'add', callback_group=g)")
    found = diagnose_blocked(
        everything, (rclpy_frame("call", "client"), own_frame(3, "self.cli.call(request)"), *WORKER), spins=True
    )
    assert found is not None
    assert "callback_group" not in found.hint


def test_the_threads_of_a_dump_are_kept_apart() -> None:
    text = """Fatal Python error: Aborted

Thread 0x00007f16a3a3e740 (most recent call first):
  File "/home/me/ws/node.py", line 8 in tick
  File "/lib/rclpy/executors.py", line 9 in handler

Current thread 0x00007f16a3a3e741 (most recent call first):
  File "/lib/rclpy/executors.py", line 3 in spin
  File "/home/me/ws/node.py", line 42 in main"""
    assert [[frame.line for frame in thread] for thread in frames_by_thread(dumped_frames(lines(text)))] == [
        [8, 9],
        [3, 42],
    ]
