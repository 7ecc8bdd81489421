"""I2.3: the next step, in terms of the learner's own file."""

from __future__ import annotations

import ast

import pytest

from checks.i2_3 import rewriting, steps, tick_steps
from checks.i2_3.callback_groups import diagnose_late_group
from tests.checks.builders import trace
from tests.judging import find_cases
from tutor.content.submissions import Case
from tutor.judge.rewriting.node import NodeFile, started_node
from tutor.judge.step_parsing import apply_step

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


def changed(*pairs: tuple[str, str]) -> NodeFile:
    """The node with each of these texts replaced."""
    code = NODE
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return NodeFile(code)


@pytest.mark.parametrize(
    ("file", "step"),
    [
        (changed((BUILT, ""), ("executor.spin()", "rclpy.spin(node)")), "executor = MultiThreadedExecutor(num_thread"),
        (changed(("executor.spin()", "rclpy.spin(node)")), "line 32 becomes: executor.spin()"),
        (  # the node has a method `spin`
            changed(
                (BUILT, ""),
                (
                    GROUPS,
                    f"{GROUPS}        self.runner = MultiThreadedExecutor()\n        self.runner.add_node(self)\n",
                ),
                ("def tick(self):", "def spin(self):\n        rclpy.spin(self)\n\n    def tick(self):"),
                ("executor.spin()", "node.spin()"),
            ),
            "line 25 becomes: self.runner.spin()",
        ),
        (
            changed(("    executor.spin()", "    rclpy.spin(node)\n    executor.spin()")),
            "remove line 32: rclpy.spin(node)",
        ),
        (
            changed(
                ("MultiThreadedExecutor(num_threads=4)", "SingleThreadedExecutor()"), ("import Multi", "import Single")
            ),
            "line 30 becomes: executor = MultiThreadedExecutor(num_threads=8)\n"
            "at the top of the file: from rclpy.executors import MultiThreadedExecutor",
        ),
        (
            changed(
                ("num_threads=4", "1"),
                (
                    "executor.spin()",
                    "thread = Thread(target=executor.spin, daemon=True)\n    thread.start()\n    rclpy.spin(node)",
                ),
            ),
            "line 34 becomes: executor.spin()\n"
            "remove line 33: thread.start()\n"
            "remove line 32: thread = Thread(target=executor.spin, daemon=True)\n"
            "line 30 becomes: executor = MultiThreadedExecutor(8)",
        ),
    ],
)
def test_a_single_thread_is_replaced_by_several(file: NodeFile, step: str) -> None:
    assert step in str(steps.use_threads(file))


@pytest.mark.parametrize(
    ("file", "held", "step"),
    [
        (changed(("num_threads=4", "num_threads=1")), "too few threads (line 30)", "num_threads=8"),
        (
            changed(("num_threads=4", "num_threads=config.get('threads', 1)"), ("=self.other", "=self.group")),
            "too few threads (line 30)",
            "num_threads=8",
        ),
        (
            changed((", callback_group=self.group", ""), (", callback_group=self.other", "")),
            "the node's default group",
            "line 14 becomes: self.timer = self.create_timer(0.1, self.tick, callback_group=self.group)",
        ),
        (
            changed(
                (GROUPS, "        self.group = MutuallyExclusiveCallbackGroup()\n"), ("=self.other", "=self.group")
            ),
            "both are in self.group",
            "line 13 becomes: self.timer = self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())",
        ),
        (  # one group with two names
            changed((GROUPS, "        self.group = self.other = MutuallyExclusiveCallbackGroup()\n")),
            "both are in self.other",
            "line 13 becomes: self.timer = self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())",
        ),
        (  # one group, which a property creates
            changed(
                (GROUPS, ""),
                ("callback_group=self.group", "callback_group=self.own"),
                ("callback_group=self.other", "callback_group=self.own"),
                (
                    "    def __init__",
                    "    @property\n    def own(self):\n        self._own = MutuallyExclusiveCallbackGroup()\n"
                    "        return self._own\n\n    def __init__",
                ),
            ),
            "both are in self.own",
            "line 17 becomes: self.timer = self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())",
        ),
        (  # another timer, faster, has a group of its own
            changed(
                (", callback_group=self.group", ""),
                (GROUPS, "        self.create_timer(0.02, self.tick, ReentrantCallbackGroup())\n"),
                ("0.1, self.tick, callback_group=self.other", "0.1, self.tick"),
            ),
            "the node's default group",
            "line 13 becomes: self.timer = self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())",
        ),
        (  # it counts what the other timer logs
            changed(
                (GROUPS, "        self.create_timer(0.1, self.count)\n"),
                (", callback_group=self.group", ""),
                ("=self.other", "=ReentrantCallbackGroup()"),
            ),
            "the service and the timer of line 11 are in the node's default group",
            "line 11 becomes: self.create_timer(0.1, self.count, callback_group=ReentrantCallbackGroup())",
        ),
        (
            changed((", callback_group=self.group", ", **options()"), (", callback_group=self.other", ", **options()")),
            "both are in the same MutuallyExclusiveCallbackGroup",
            "line 14 becomes: self.timer = self.create_timer(0.1, self.tick, callback_group=self.group)",
        ),
    ],
)
def test_a_timer_blocked_by_its_group_or_by_too_few_threads(file: NodeFile, held: str, step: str) -> None:
    assert held in steps.what_timer_waits_for(file)
    assert step in str(steps.separate_groups(file))


@pytest.mark.parametrize(
    ("file", "step"),
    [
        (changed(("self.group = Reentrant", "self.group = MutuallyExclusive")), "callback_group=ReentrantC"),
        (changed((", callback_group=self.group", "")), "self.add, callback_group=ReentrantCallbackGroup())"),
        (changed(("num_threads=4", "num_threads=2")), "line 30 becomes: executor = MultiThreadedExecutor(num_thr"),
    ],
)
def test_calls_are_allowed_to_overlap(file: NodeFile, step: str) -> None:
    assert step in str(steps.allow_overlap(file))


@pytest.mark.parametrize(
    ("file", "cause", "step"),
    [
        (changed((TICK, "")), "no timer messages", "self.get_logger().info(f'Tick {self.count}')"),
        (changed((".info(", ".debug(")), "no timer messages", "line 24 becomes: self.get_logger().info("),
        (
            changed(("__init__('concurrent_service'", "__init__('concurrent_service', enable_rosout=False")),
            "no timer messages",
            "line 10 becomes: super().__init__('concurrent_service', enable_rosout=True)",
        ),
        (
            changed(("create_timer(0.1", "create_timer(10.0")),
            "wrong timer period",
            "line 14 becomes: self.timer = self.create_timer(0.1,",
        ),
    ],
)
def test_causes_of_no_timer_messages(file: NodeFile, cause: str, step: str) -> None:
    found = tick_steps.diagnose_no_ticks(file)
    assert found is not None
    assert found.name == cause
    assert step in found.hint


def test_steps_that_change_single_lines() -> None:
    assert steps.fix_work_time(changed(("sleep(3.0)", "sleep(1)"))) == "line 18 becomes: time.sleep(3.0)"
    assert tick_steps.fix_period(changed(("timer(0.1", "timer(1.0"))) == (
        "line 14 becomes: self.timer = self.create_timer(0.1, self.tick, callback_group=self.other)"
    )
    waits = changed(("time.sleep(3.0)", "threading.Event().wait()"), ("import time", "import threading"))
    assert steps.remove_wait(waits, "threading.Event().wait()", 18) == "line 18 becomes: threading.Event().wait(3.0)"
    named = changed(("'slow_add'", "'slow_sum'"))
    assert "AddTwoInts, 'slow_add', self.add" in str(steps.fix_service(named))
    spaced = changed(("__init__('concurrent_service'", "__init__('concurrent_service', namespace='x'"))
    assert "AddTwoInts, '/slow_add', self.add" in str(steps.fix_service(spaced))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("        response.sum = request.a + request.b\n", ""),
        ("response.sum = request.a", "self.sum = request.a"),
        ("        time.sleep(3.0)\n", "        with self.lock:\n            time.sleep(3.0)\n"),
        ("def add(self, request, response):", "async def add(self, request, response):"),
        ("def add(self, request, response):", "def add(self, request):"),
    ],
)
def test_the_callback_is_rewritten_as_a_whole(old: str, new: str) -> None:
    step = str(steps.fix_answer(changed((old, new))))
    assert "time.sleep(3.0)\n" in step
    assert "response.sum = request.a + request.b\n" in step
    assert "return response" in step


def test_work_in_another_thread_answers_too_early() -> None:
    found = steps.diagnose_early_answer(
        changed(("time.sleep(3.0)", "Thread(target=self.work, args=(request, response)).start()"))
    )
    assert found is not None
    assert found.name == "answered too early"
    assert "response.sum = request.a + request.b\n    return response" in found.hint


def test_an_executor_without_a_node() -> None:
    found = steps.diagnose_node_not_added(changed(("    executor.add_node(node)\n", "")))
    assert found is not None
    assert "executor.add_node(node)\n" in found.hint


def test_the_same_step_is_not_suggested_again() -> None:
    """Correct code is not rewritten, only other code that may be to blame."""
    right = NodeFile(NODE)
    assert rewriting.rewrite_service_callback(right)
    step = str(steps.fix_answer(right))
    assert "response.sum" not in step
    assert "ReentrantCallbackGroup()" in step


@pytest.mark.parametrize("case", find_cases(["i2.3"])[0], ids=str)
def test_each_submission_can_be_rewritten(case: Case) -> None:
    """If Python can parse it at all, and its only file has a node."""
    for path in case.folder.glob("concurrent_service.py"):
        try:
            ast.parse(text := path.read_text())
        except SyntaxError:
            continue
        assert steps.rewrite_everything(NodeFile(text)) or "create_service" not in text


def test_an_empty_file_yields_no_steps() -> None:
    for step in (
        steps.use_threads,
        steps.allow_overlap,
        steps.fix_work_time,
        tick_steps.fix_period,
        tick_steps.diagnose_no_ticks,
        steps.fix_service,
    ):
        assert step(NodeFile("")) is None, step


def test_a_step_names_its_file_if_there_are_others() -> None:
    file = started_node(trace(sources={"node.py": NODE.replace("time.sleep(3.0)", "time.sleep(9.0)"), "other.py": ""}))

    assert steps.fix_work_time(file) == "in node.py, line 18 becomes: time.sleep(3.0)"


def test_a_timer_created_in_each_call_moves_next_to_the_service() -> None:
    made = "        self.timer = self.create_timer(0.1, self.tick, callback_group=self.other)\n"
    file = changed((made, ""), ("        time.sleep(3.0)\n", f"{made}        time.sleep(3.0)\n"))

    step = tick_steps.rewrite_ticking(file)

    assert step is not None
    code = apply_step(step, {"node.py": file.text})["node.py"]
    assert code.count("create_timer(") == 1
    assert code.index("create_timer(") < code.index("def add(")


def test_a_wait_that_returns_at_once_becomes_a_sleep() -> None:
    waits = changed(
        ("        time.sleep(3.0)", "        self.running.wait(self.seconds)"),
        ("= 0\n", "= 0\n        self.seconds = 3.0\n"),
    )
    assert "time.sleep(3.0)" in str(steps.fix_work_time(waits))
    short = changed(("        time.sleep(3.0)", "        self.running.wait(1.0)"))
    assert "self.running.wait(3.0)" in str(steps.fix_work_time(short))


def test_work_that_stops_all_threads_is_not_put_down_to_the_executor() -> None:
    separate = changed(("        time.sleep(3.0)", "        sum(range(10**9))"))
    assert "one thread at a time" in steps.what_timer_waits_for(separate)
    assert "MutuallyExclusiveCallbackGroup" in steps.what_timer_waits_for(separate, sleeps=True)
    assert "time.sleep(3.0)" in str(steps.separate_groups(separate))


LATE = (GROUPS, GROUPS + "\n    def start(self):\n")
"""Something, such as the constructor of a base class, calls start() before the groups are set."""


def test_a_group_that_is_set_after_its_timer_was_created() -> None:
    cause = diagnose_late_group(changed(LATE))
    assert cause is not None
    assert cause.name == "callback group set too late"
    assert "line 16 creates the timer before line 12 sets self.other" in cause.text
    assert "line 16 becomes: self.timer = self.create_timer(0.1, self.tick, callback_group=Reentrant" in str(cause.hint)


@pytest.mark.parametrize(
    "pairs",
    [
        (),  # the group is set in the same function, so it exists
        (LATE, ("self.other = Mut", "self.another = Mut")),
        (LATE, ("node = ConcurrentService()", "node = ConcurrentService()\n    node.start()")),
        (  # set in a method that is called before
            (
                GROUPS,
                f"        self.make_groups()\n        self.start()\n\n    def make_groups(self):\n{GROUPS}\n"
                "    def start(self):\n",
            ),
        ),
        ((GROUPS, f"{GROUPS}        self.start()\n\n    def start(self):\n"),),
    ],
)
def test_a_group_that_is_set_in_time(pairs: tuple[tuple[str, str], ...]) -> None:
    assert diagnose_late_group(changed(*pairs)) is None


def test_a_timer_callback_gets_no_event() -> None:
    ported = changed(("def tick(self):", "def tick(self, event):"), (TICK, "        print(event.current_real)\n"))
    after = apply_step(str(ported.step(rewriting.rewrite_timer_callback(ported))), {"my_node.py": ported.text})
    assert "def tick(self):" in after["my_node.py"]
    assert "event" not in after["my_node.py"]


def test_what_a_lambda_passes_to_a_timer_callback_is_kept() -> None:
    named = changed(
        ("def tick(self):", "def tick(self, name):"),
        ("self.tick,", "lambda: self.tick('fast'),"),
        (TICK, "        print(name)\n"),
    )
    after = apply_step(str(named.step(rewriting.rewrite_timer_callback(named))), {"my_node.py": named.text})
    assert "def tick(self, name):" in after["my_node.py"]
