"""I1.2: following the step that rewrites the callback, in files of many shapes."""

from __future__ import annotations

import ast

import pytest

from checks.i1_2 import rewriting
from checks.i1_2.listener import find_listener
from tests.checks.builders import trace
from tests.repairs import apply_step

METHOD = """\
class Stats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.anzahl = 1
        self.sub = self.create_subscription(
            String, 'chatter', callback=self.gehoert, qos_profile=10)

    def gehoert(self, nachricht):
        '''Takes in one message.'''
        if self.anzahl == 1:
            self.erste = nachricht.data
        self.anzahl += 1
        self.letzte = nachricht.data
"""
LAMBDA = METHOD.replace("self.gehoert", "lambda m: self.gehoert(m.data)").replace("nachricht.data", "nachricht")
NOTHING = METHOD.replace("self.gehoert", "lambda m: None")
GLOBAL = """\
import time
count = 0

def heard(msg):
    global count
    count += 1

def main():
    node = rclpy.create_node('message_stats')
    node.create_subscription(String, 'chatter', lambda msg: heard(msg), 10)
"""
CLOSURE = """\
def main():
    node = rclpy.create_node('message_stats')
    stats = {'count': 0}

    def heard(msg):
        stats['count'] += 1

    node.create_subscription(String, 'chatter', heard, 10)
"""
ELSEWHERE = """\
class Tracker:
    def on_message(self, msg):
        self.last = msg.data

class Stats(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.tracker = Tracker()
        self.create_subscription(String, 'chatter', self.tracker.on_message, 10)
"""
TIMER = (
    METHOD.replace("        self.sub", "        self.create_timer(1.0, self.tick)\n        self.sub")
    + """\

    def tick(self):
        self.get_logger().info(f'{self.letzte}')
"""
)


def rewrite(code: str) -> str:
    """The file after following the step, which must not be suggested again."""
    step = rewriting.rewrite_callback(trace(sources={"node.py": code}))
    assert step is not None
    fixed = apply_step(step, {"node.py": code})["node.py"]
    ast.parse(fixed)
    assert rewriting.rewrite_callback(trace(sources={"node.py": fixed})) is None
    return fixed


@pytest.mark.parametrize(
    ("code", "lines"),
    [
        pytest.param(
            METHOD,
            [
                "import time",
                "        self.anzahl = 0",
                "        self.last_number = None",
                "        '''Takes in one message.'''",
                "        if self.anzahl == 0:",
                "            self.erste = nachricht.data",
                "            self.get_logger().info(f'first: {self.erste}, last: {self.letzte}')",
            ],
            id="method",
        ),
        pytest.param(
            LAMBDA,
            ["            self.first_message = nachricht", "        self.last_message = nachricht"],
            id="text given",
        ),
        pytest.param(
            NOTHING,
            [
                "            String, 'chatter', callback=self.on_message, qos_profile=10)",
                "    def on_message(self, message):",
                "        self.last_message = message.data",
            ],
            id="lambda",
        ),
        pytest.param(
            CLOSURE,
            [
                "    total_count = 0",
                "        nonlocal total_count, first_message, last_message, start_time, last_number",
            ],
            id="closure",
        ),
        pytest.param(
            ELSEWHERE,
            [
                "        self.create_subscription(String, 'chatter', self.on_chatter, 10)",
                "    def on_chatter(self, message):",
            ],
            id="another class",
        ),
    ],
)
def test_the_callback_is_rewritten(code: str, lines: list[str]) -> None:
    fixed = rewrite(code).splitlines()
    assert [line for line in lines if line not in fixed] == []


def test_a_module_level_callback_declares_its_globals() -> None:
    run = trace(
        sources={"node.py": GLOBAL.replace("    global count\n", "    global count\n    log = rclpy.logging\n")}
    )
    assert rewriting.rewrite_callback(run) is not None
    fixed = rewrite(GLOBAL.replace("    count += 1", "    count += 1\n    log.info('a message')"))
    assert "    global count, first_message, last_message, start_time, last_number\n" in fixed
    assert "\nfirst_message = ''\n" in fixed
    assert "    log.info(f'{count} messages, {rate:.2f} per second')\n" in fixed


def test_a_timer_that_logs_is_removed() -> None:
    fixed = rewrite(TIMER)
    assert "create_timer" not in fixed
    assert "def tick" not in fixed


def test_a_timer_that_the_callback_creates_goes_with_its_old_body() -> None:
    created = TIMER.replace("        self.create_timer(1.0, self.tick)\n", "")
    created = created.replace(
        "(self, nachricht):\n", "(self, nachricht):\n        self.create_timer(1.0, self.tick)\n", 1
    )
    assert "create_timer" in created
    fixed = rewrite(created)
    assert "create_timer" not in fixed
    assert "def tick" not in fixed


def test_a_loop_that_logs_between_two_spins_only_spins() -> None:
    code = """\
class Stats(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.total = 0
        self.create_subscription(String, "chatter", self.count, 10)

    def count(self, msg):
        self.total += 1


rclpy.init()
stats = Stats()
while rclpy.ok():
    for _ in range(10):
        rclpy.spin_once(stats, timeout_sec=0.1)
    stats.get_logger().info(f"{stats.total} messages")
"""
    fixed = rewrite(code)
    assert fixed.endswith("stats = Stats()\nrclpy.spin(stats)\n")
    assert "self.get_logger().info(f'first: " in fixed


def test_a_callback_of_another_object_gets_no_logger_of_the_node() -> None:
    code = """\
class Parser:
    def __init__(self, on_text):
        self.on_text = on_text

    def receive(self, msg):
        self.on_text(msg.data)


class Stats(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.parser = Parser(self.count)
        self.create_subscription(String, "chatter", self.parser.receive, 10)

    def count(self, text):
        self.get_logger().info(text)
"""
    fixed = rewrite(code)
    assert fixed.index("class Stats") < fixed.index("self.get_logger().info(f'first: ")


@pytest.mark.parametrize("code", ["", "def f(:", "class Stats(Node):\n    pass\n"])
def test_without_a_subscription_there_is_no_step(code: str) -> None:
    assert rewriting.rewrite_callback(trace(sources={"node.py": code})) is None


OTHER_TOPIC = METHOD.replace(
    "        self.sub =", "        self.create_subscription(Int64, '/ping', self.on_ping, 10)\n        self.sub ="
).replace("    def gehoert", "    def on_ping(self, ping):\n        pass\n\n    def gehoert")
DERIVED = """\
class Base(Node):
    def __init__(self):
        self.sub = self.create_subscription(String, 'chatter', self.heard, 10)
    def heard(self, message):
        self.get_logger().info(message.data)
class Stats(Base):
    def heard(self, message):
        self.last = message.data
"""


@pytest.mark.parametrize(("code", "name", "line"), [(OTHER_TOPIC, "gehoert", 12), (DERIVED, "heard", 7)])
def test_the_callback_is_the_one_for_the_topic_and_of_the_derived_class(code: str, name: str, line: int) -> None:
    found = find_listener(trace(sources={"node.py": code}))
    assert found is not None
    assert (found.function.name, found.function.lineno) == (name, line)


def test_the_callback_of_a_derived_class_may_be_in_another_file() -> None:
    base, derived = DERIVED.split("class Stats")
    found = find_listener(trace(sources={"stats.py": f"class Stats{derived}", "base.py": base}))
    assert found is not None
    assert (found.file.file, found.function.name, found.logger) == ("stats.py", "heard", "self.get_logger()")
