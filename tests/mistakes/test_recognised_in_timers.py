"""Which mistake is told for messages at a wrong rate, from the learner's code; and for code that is right, none."""

from __future__ import annotations

import pytest

from tests.mistakes.cases import assert_told, told
from tutor.judge.symptom import Symptom

NOTHING = "wrong-rate"
CLASS = "class N(Node):\n  def __init__(self):\n    super().__init__('n')\n"
MADE = "class A(Node):\n    def __init__(self):\n        self.timer = self.create_timer({})\n        {}\n"
TWO = (
    CLASS
    + """\
    self.t = self.create_timer(0.5, self.tick)
    self.set_rate(2)
  def set_rate(self, rate):
    self.u = self.create_timer(1 / rate, self.tick)
"""
)
TWINS = CLASS + "    self.t = self.create_timer(0.1, self.tick)\n    self.t = self.create_timer(0.1, self.{}, group)\n"
TICK = """\
import time
class N(Node):
  def __init__(self):
    self.create_timer(0.1, self.tick)
  def tick(self):
    {}
    self.pub.publish(String())
"""
ENDING = """\
class A(Node):
    def __init__(self):
        self.timer = self.create_timer(0.1, self.tick)

    def tick(self):
        {}
        self.log()
"""
LOOP = "def main():\n    while rclpy.ok():\n        publisher.publish(Float64())\n        time.sleep({})\n"
SPINNING = """\
class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.pub = self.create_publisher(String, 'chatter', 10)

    def tick(self):
        self.pub.publish(String(data='Hello'))


def main():
    talker = Talker()
    while rclpy.ok():
        {}
"""
GROUPED = """\
class Sensors(Node):
    def __init__(self):
        super().__init__('sensors')
        self.group = ReentrantCallbackGroup()
        self.create_timer(0.5, self.publish{})
        self.create_timer(2.0, self.measure)


executor = MultiThreadedExecutor()
"""


@pytest.mark.parametrize(
    ("source", "mistake", "words"),
    [
        ("self.create_timer(500, self.tick)", "wrong-timer-period", "500 seconds"),
        ("PERIOD = 100\nself.create_timer(PERIOD, self.tick)", "wrong-timer-period", "node.py:1"),
        ("self.create_timer(1000 / self.rate, self.tick)", "wrong-timer-period", "1000 divided by the rate"),
        ("self.t.timer_period_ns = 100000000 // rate", "wrong-timer-period", "nanoseconds"),
        ("self.t.timer_period_ns = 1e9 // rate", NOTHING, ""),
        ("self.t.timer_period_ns = 1000000000 // rate", NOTHING, ""),
        ("self.create_timer(5, self.tick)", NOTHING, ""),
        ("self.create_timer(1.0 / self.rate, self.tick)", NOTHING, ""),
        ("self.create_timer(1 // self.rate, self.tick)", "period-made-a-whole-number", "line 1"),
        ("self.create_timer(int(1 / self.rate), self.tick)", "period-made-a-whole-number", "line 1"),
        ("self.period = 1 // self.rate\nself.create_timer(self.period, self.tick)", "period-made-a-whole-number", ""),
        (MADE.format("0.1, self.tick, autostart=False", ""), "timer-not-started", "line 3"),
        (MADE.format("0.1, self.tick, autostart=False", "self.timer.reset()"), NOTHING, ""),
        (MADE.format("0.1, self.tick, autostart=True", ""), NOTHING, ""),
        (MADE.format("0.1, self.tick", ""), NOTHING, ""),
        (MADE.format("1.0, self.tick", "self.timer.period = 1.0 / hz"), "no-such-attribute-of-a-timer", "line 4"),
        (MADE.format("1.0, self.tick", "self.timer.timer_period_sec = 0.5"), "no-such-attribute-of-a-timer", "line 4"),
        (MADE.format("1.0, self.tick", "self.timer.timer_period_ns = 5"), NOTHING, ""),
        (MADE.format("1.0, self.tick", "self.period = 1.0 / hz"), NOTHING, ""),
        (TWO, "two-timers", "line 4"),
        (TWO.replace("0.5", "1.0 / HZ") + "HZ = 2.0\n", "two-timers", "line 4"),
        (TWO.replace("rate, self.tick", "rate, self.tock"), NOTHING, ""),
        (TWO.replace("    self.set_rate(2)\n", ""), NOTHING, ""),
        (TWINS.format("tick"), "two-timers", "line 4"),
        (TWINS.format("tock"), NOTHING, ""),
        (f"{CLASS}    for room in ROOMS:\n      self.create_timer(1 / rate, self.tick)\n", "several-timers", "line 4"),
        (
            f"{CLASS}    for room in ROOMS:\n      self.add(room)\n    self.create_timer(1 / rate, self.tick)\n",
            NOTHING,
            "",
        ),
        (ENDING.format("if self.n > 20:\n            self.timer.cancel()"), "timer-cancelled", "line 7"),
        (ENDING.format("self.destroy_timer(self.timer)"), "timer-cancelled", "line 6"),
        (ENDING.format("self.other.cancel()"), NOTHING, ""),
        (ENDING.format("self.n += 1"), NOTHING, ""),
        (TICK.format("if time.monotonic() - self.last < self.period:\n      return"), "ticks-dropped", "line 6"),
        (TICK.format("if self.count < 5:\n      return"), NOTHING, ""),
        (TICK.format("if time.monotonic() - self.last < self.period:\n      self.hurry()"), NOTHING, ""),
        (TICK.format("time.sleep(0.5)"), "callback-sleeps", "line 6"),
        (TICK.format("time.sleep(0.01)"), NOTHING, ""),
        (TICK.format("for _ in range(50):\n      time.sleep(0.01)"), "callback-sleeps", "line 7"),
        (LOOP.format("0.5"), "callback-sleeps", "line 4"),
        (LOOP.format("left"), NOTHING, ""),  # the rest of the period
        (GROUPED.format(""), "callback-group-not-used", "line 4"),
        (GROUPED.format(", self.group"), NOTHING, ""),
        ("p = Parameter('use_sim_time', Parameter.Type.BOOL, True)", "simulated-time", "line 1"),
        ("p = {'a': True, 'use_sim_time': True}", "simulated-time", "line 1"),
        ("p = {'name': 'use_sim_time', 'value': True}", "simulated-time", "line 1"),
        ("n.declare_parameter('use_sim_time', value=True)", "simulated-time", "line 1"),
        ("SIM = True\nn.set('use_sim_time', SIM)", "simulated-time", "line 2"),
        ("p = Parameter('use_sim_time', value=False)", NOTHING, ""),
        ("n.get_parameter('use_sim_time')", NOTHING, ""),
        (
            "while rclpy.ok():\n    executor.spin_once(timeout_sec=0.2)\n    time.sleep(0.2)",
            "nap-between-callbacks",
            "3",
        ),
        ("while rclpy.ok():\n    executor.work(timeout_sec=0.2)\n    time.sleep(0.2)", NOTHING, ""),
        (SPINNING.format("talker.tick()\n        rclpy.spin_once(talker)"), "spin-once-waits", "line 14"),
        (SPINNING.format("talker.tick()\n        rclpy.spin_once(talker, timeout_sec=0.1)"), NOTHING, ""),
        (SPINNING.format("rclpy.spin_once(talker)"), NOTHING, ""),
        (
            "while rclpy.ok():\n    for node in self.nodes:\n        rclpy.spin_once(node, executor=self.executor)",
            "spin-once-waits",
            "line 3",
        ),
        ("for node in nodes:\n    rclpy.spin_once(node, timeout_sec=0.1)", NOTHING, ""),
        ("for future in futures:\n    while not future.done():\n        rclpy.spin_once(talker)", NOTHING, ""),
    ],
)
def test_why_a_rate_is_wrong(source: str, mistake: str, words: str) -> None:
    assert_told(told(Symptom.WRONG_RATE, source, wanted_hz=5.0), mistake, words)


HELPER = """\
import time


class Sensor:
    CONVERSION_S = 0.75

    def {1}(self):
        time.sleep({0})
        return 20.0
"""


WAITS = "def main():\n    while rclpy.ok():\n        publisher.publish(Float64())\n        rate.read()\n"


def test_a_helper_that_makes_the_loop_wait_for_its_next_round() -> None:
    files = {"rate.py": HELPER.format("self.left()", "read")}
    assert_told(told(Symptom.WRONG_RATE, WAITS, files=files, wanted_hz=5.0), NOTHING)


@pytest.mark.parametrize(
    ("function", "sleep", "mistake"),
    [
        ("read", "self.CONVERSION_S", "callback-sleeps"),
        ("read", "0.5", "callback-sleeps"),
        ("read", "0.005", NOTHING),
        ("read", "self.left()", "callback-sleeps"),
        ("_run_loop", "0.5", NOTHING),
    ],
)
def test_a_helper_that_sleeps(function: str, sleep: str, mistake: str) -> None:
    node = TICK.format("self.value = self.sensor.read()")
    found = told(Symptom.WRONG_RATE, node, files={"sensor.py": HELPER.format(sleep, function)}, wanted_hz=5.0)
    assert_told(found, mistake, "sensor.py:8" if mistake != NOTHING else "")


BASE = """
class Base(Node):
    def __init__(self, name):
        super().__init__(name)
        self.set_up()

    def listen(self, topic, callback):
        self.create_subscription(String, topic, callback, 10)
"""
DERIVED = """
class Stats(Base):
    def __init__(self):
        super().__init__("stats")
        self.count = 0
        self.set_up()

    def set_up(self):
        self.listen("chatter", self.heard)
"""


@pytest.mark.parametrize(
    ("derived", "mistake"),
    [
        (DERIVED, "set-up-twice"),
        (DERIVED.replace("        self.set_up()\n", ""), "wrong-log"),
        (DERIVED.replace("(Base)", "(Node)"), "wrong-log"),
        (DERIVED.replace("self.listen(", "print("), "wrong-log"),
    ],
)
def test_a_base_class_in_another_file_that_has_set_the_node_up(derived: str, mistake: str) -> None:
    found = told(Symptom.WRONG_LOG, derived, files={"base.py": BASE})
    assert_told(found, mistake, "Base's constructor has called already" if mistake != "wrong-log" else "")


RETIMED = """
class Publisher(Periodic):
    def __init__(self):
        self.__timer = None
        super().__init__()
        self.add_post_set_parameters_callback(self.apply)

    def apply(self, params):
        self.__timer.cancel()
        self.__timer = self.create_timer(1.0 / params[0].value, self.tick)
"""
PERIODIC = """
class Periodic(Node):
    def __init__(self):
        super().__init__("periodic")
        self.TIMER = self.create_timer(1.0, self.tick)
"""


def test_a_timer_that_replaces_that_of_the_base_class() -> None:
    files = {"base.py": PERIODIC.replace("TIMER", "timer")}
    assert_told(told(Symptom.WRONG_RATE, RETIMED.replace("__timer", "timer"), files=files), NOTHING)
