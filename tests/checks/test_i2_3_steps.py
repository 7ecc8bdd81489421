"""I2.3: the next step in the words of the learner's own file."""

from __future__ import annotations

import pytest

from checks.i2_3 import steps
from tutor.judge.reading import UNREAD, Source

NODE = """\
import time
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.group = ReentrantCallbackGroup()
        self.other = MutuallyExclusiveCallbackGroup()
        self.create_service(AddTwoInts, 'slow_add', self.add, callback_group=self.group)
        self.timer = self.create_timer(0.1, self.tick, callback_group=self.other)
        self.count = 0

    def add(self, request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def tick(self):
        self.count += 1
        self.get_logger().info(f'Tick {self.count}')


def main():
    rclpy.init()
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    executor.spin()
"""
GROUPS = "        self.group = ReentrantCallbackGroup()\n        self.other = MutuallyExclusiveCallbackGroup()\n"
BUILT = "    executor = MultiThreadedExecutor(num_threads=4)\n    executor.add_node(node)\n"
TICK = "        self.get_logger().info(f'Tick {self.count}')\n"


def changed(*pairs: tuple[str, str]) -> Source:
    """The node with something of it written otherwise."""
    code = NODE
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return Source(code)


@pytest.mark.parametrize(
    ("source", "step"),
    [
        (
            changed((BUILT, ""), ("executor.spin()", "rclpy.spin(node)")),
            "instead of line 30, rclpy.spin(node):\nexecutor = MultiThreadedExecutor(num_threads=8)\n"
            "executor.add_node(node)\nexecutor.spin()",
        ),
        (changed(("executor.spin()", "rclpy.spin(node)")), "line 32: executor.spin() instead of rclpy.spin(node)"),
        (
            changed(("    executor.spin()", "    rclpy.spin(node)\n    executor.spin()")),
            "remove line 32, rclpy.spin(node): it never ends, so that line 33 is not reached",
        ),
        (
            changed(("        self.count = 0\n", "        self.count = 0\n        rclpy.spin(self)\n")),
            "remove line 16, rclpy.spin(self)",
        ),
        (
            changed(
                ("MultiThreadedExecutor(num_threads=4)", "SingleThreadedExecutor()"), ("import Multi", "import Single")
            ),
            "line 30: executor = MultiThreadedExecutor(num_threads=8)\n"
            "at the top of the file: from rclpy.executors import MultiThreadedExecutor",
        ),
    ],
)
def test_one_thread_for_all(source: Source, step: str) -> None:
    assert str(steps.executor(source)).startswith(step)


@pytest.mark.parametrize(
    ("source", "held", "step"),
    [
        (changed(("num_threads=4", "num_threads=1")), "too few threads, 1 (line 30)", "num_threads=8"),
        (
            changed((", callback_group=self.group", ""), (", callback_group=self.other", "")),
            "the node's default group",
            "line 14: self.timer = self.create_timer(0.1, self.tick, callback_group=self.group)",
        ),
        (
            changed(
                (GROUPS, "        self.group = MutuallyExclusiveCallbackGroup()\n"), ("=self.other", "=self.group")
            ),
            "both are in self.group",
            "line 13: self.timer = self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())",
        ),
    ],
)
def test_held_by_a_group_or_by_few_threads(source: Source, held: str, step: str) -> None:
    assert held in steps.held_by(source)
    assert step in str(steps.threads(source) or steps.groups(source))


def test_nothing_is_advised_that_is_there() -> None:
    right = Source(NODE)
    for step in (
        steps.executor,
        steps.threads,
        steps.groups,
        steps.not_added,
        steps.too_early,
        steps.shared,
        steps.lock,
    ):
        assert step(right) is None, step
    assert steps.period(right) is None
    assert steps.silent(right) is None


@pytest.mark.parametrize(
    ("source", "step"),
    [
        (changed(("self.group = Reentrant", "self.group = MutuallyExclusive")), "line 11: self.group = ReentrantC"),
        (changed((", callback_group=self.group", "")), "self.add, callback_group=ReentrantCallbackGroup())"),
        (changed(("num_threads=4", "num_threads=2")), "line 30: executor = MultiThreadedExecutor(num_threads=8)"),
    ],
)
def test_one_call_at_a_time(source: Source, step: str) -> None:
    assert step in str(steps.apart(source))


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (changed((TICK, "")), "no timer messages", "end tick with: self.get_logger().info(f'Tick {self.count}')"),
        (changed((".info(", ".debug(")), "no timer messages", "line 24: self.get_logger().info(f'Tick {self.count}')"),
        (
            changed(("create_timer(0.1", "create_timer(10.0")),
            "wrong timer period",
            "self.timer = self.create_timer(0.1,",
        ),
    ],
)
def test_no_messages_of_the_timer(source: Source, cause: str, step: str) -> None:
    found = steps.silent(source)
    assert found is not None
    assert found.name == cause
    assert step in found.hint


def test_steps_of_one_line() -> None:
    assert steps.work(changed(("sleep(3.0)", "sleep(1)"))) == "line 18: time.sleep(3.0)"
    assert steps.work(changed(("        time.sleep(3.0)\n", ""), ("import time\n", ""))) == (
        "begin add (line 16) with: time.sleep(3.0)\nat the top of the file: import time"
    )
    assert "line 14: self.timer = self.create_timer(0.1," in str(steps.period(changed(("timer(0.1", "timer(1.0"))))
    assert steps.numbered(changed((TICK, TICK))) == "line 24: self.get_logger().info(f'Tick {self.count}')"
    assert steps.waiting("self.done.wait()", 23) == "line 23: time.sleep(3.0) instead of self.done.wait()"
    assert steps.waiting("time.sleep(9)", 23) is None
    one = changed(("response.sum = request.a", "self.sum = request.a"))
    assert steps.shared(one) == "in add (line 17), write sum instead of self.sum"


def test_work_beside_the_callback_answers_too_early() -> None:
    found = steps.too_early(changed(("time.sleep(3.0)", "Thread(target=self.work, args=(request, response)).start()")))
    assert found is not None
    assert found.name == "answered too early"
    assert "response.sum = request.a + request.b\nreturn response" in found.hint


def test_an_executor_without_a_node() -> None:
    found = steps.not_added(changed(("    executor.add_node(node)\n", "")))
    assert found is not None
    assert found.hint == "right before line 31: executor.add_node(node)"


def test_a_lock_that_both_hold() -> None:
    locked = changed(
        ("        time.sleep(3.0)\n", "        with self.lock:\n            time.sleep(3.0)\n"),
        ("        self.count += 1\n", "        with self.lock:\n            self.count += 1\n"),
    )
    assert str(steps.lock(locked)).startswith("leave `with self.lock:` out of tick")
    assert str(steps.apart(locked)).startswith("leave `with self.lock:` out of add (line 17)")


def test_what_cannot_be_read_leaves_the_plain_words() -> None:
    for step in (steps.executor, steps.groups, steps.apart, steps.work, steps.period, steps.numbered, steps.silent):
        assert step(UNREAD) is None, step
