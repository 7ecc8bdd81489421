"""I1.1: the next step, in terms of the learner's own file."""

from __future__ import annotations

from dataclasses import replace

import pytest

from checks.i1_1 import steps
from tests.repairs import apply_step
from tutor.judge.trace import LogRecord, Trace

NODE = """\
import random
from std_msgs.msg import Float64


class Sensor(Node):
    def __init__(self):
        super().__init__('sensor')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'one')
        self.rate = self.get_parameter('publish_rate').value
        self.sensor = self.get_parameter('sensor_name').value
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.tick)

    def tick(self):
        msg = Float64()
        msg.data = random.uniform(20.0, 30.0)
        self.publisher.publish(msg)
        self.get_logger().info(f'{self.sensor}: {msg.data}')
"""


def changed(*pairs: tuple[str, str]) -> Trace:
    """The node with each of these texts replaced."""
    code = NODE
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return Trace("node.py", sources={"node.py": code})


def follow_step(step: str, trace: Trace) -> str:
    """The file after following the step to the letter."""
    return apply_step(step, trace.sources)["node.py"]


@pytest.mark.parametrize(
    ("trace", "line"),
    [
        (changed(("random.uniform(20.0, 30.0)", "self.value")), "        msg.data = random.uniform(20.0, 30.0)\n"),
        (
            changed(("        msg.data = random.uniform(20.0, 30.0)\n", ""), ("Float64()", "Float64(data=self.value)")),
            "        msg = Float64(data=random.uniform(20.0, 30.0))\n",
        ),
        (changed(("random.uniform(", "int("), ("import random\n", "")), "import random\n"),
        (changed(("random.uniform(", "int("), ("import random\n", "import random as r\n")), "= r.uniform(20.0, 30.0)"),
        (changed(("random.uniform(", "int("), ("import random\n", "from random import random\n")), "= uniform(20.0"),
    ],
)
def test_the_step_draws_random_values(trace: Trace, line: str) -> None:
    assert line in follow_step(steps.draw_values(trace), trace)


def test_seeding_in_every_callback_is_removed() -> None:
    trace = changed(("        msg =", "        random.seed(1)\n        msg ="))
    assert follow_step(steps.draw_values(trace), trace) == NODE


def test_a_value_that_is_already_random_gets_the_whole_callback_rewritten() -> None:
    trace = changed(
        ("        self.publisher.p", "        msg.data = random.uniform(20.0, 30.0)\n        self.publisher.p")
    )
    assert steps.draw_values(trace).startswith("lines 15 to 20 become:\n    def tick(self):")


def test_an_int_becomes_a_float() -> None:
    assert steps.make_float(changed(("random.uniform(20.0, 30.0)", "25"))) == "line 17 becomes: msg.data = float(25)"


@pytest.mark.parametrize(
    ("trace", "cause", "line"),
    [
        (
            changed(
                (
                    "self.rate = self.get_parameter('publish_rate').value",
                    "self.rate = int(self.get_parameter('publish_rate').value)",
                )
            ),
            "rate made a whole number",
            "self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)",
        ),
        (changed(("1.0 / self.rate", "1 // self.rate")), "period made a whole number", "(1 / self.rate"),
        (changed(("1.0 / self.rate", "1000.0 / self.rate")), "wrong timer period", "timer(1.0 / self.rate"),
        (
            changed(("        self.publisher.p", "        time.sleep(0.75)\n        self.publisher.p")),
            "callback sleeps",
            "msg = Float64()",
        ),
        (
            changed(("        self.timer =", "        self.rate = 1.0\n        self.timer =")),
            "value overwritten by the node",
            "value\n        self.publisher",
        ),
    ],
)
def test_causes_of_a_wrong_rate(trace: Trace, cause: str, line: str) -> None:
    found = steps.diagnose_rate(trace, "publish_rate", 8.0)
    assert found is not None
    assert found.name == cause
    assert line in follow_step(found.hint, trace)


@pytest.mark.parametrize(
    ("unit", "code"),
    [
        ("Hz", "1.0 / self.get_parameter('period').value"),
        ("s", "self.get_parameter('period').value"),
        ("ms", "self.get_parameter('period').value / 1000.0"),
    ],
)
def test_the_step_sets_the_timer_period(unit: str, code: str) -> None:
    assert (
        steps.set_timer_period(changed(), "period", unit)
        == f"line 13 becomes: self.timer = self.create_timer({code}, self.tick)"
    )


@pytest.mark.parametrize(
    ("trace", "cause", "line"),
    [
        (changed((".info(", ".debug(")), "logged at DEBUG", ".info(f'{self.sensor}: {msg.data}')"),
        (
            replace(
                changed(("info(f'", "info('")), logs=(LogRecord(20, "sensor", "{self.sensor}: {msg.data}", 1.0, 1.0),)
            ),
            "no f in front of the text",
            ".info(f'{self.sensor}: {msg.data}')",
        ),
        (
            changed(("{self.sensor}: ", "")),
            "parameter ignored",
            "        self.get_logger().info(str(self.get_parameter('sensor_name').value))\n        self.pub",
        ),
    ],
)
def test_the_step_logs_the_name(trace: Trace, cause: str, line: str) -> None:
    found = steps.diagnose_name(trace, "sensor_name")
    assert found.name == cause
    assert line in follow_step(found.hint, trace)


def test_an_undeclared_parameter_is_declared_and_used() -> None:
    rate = follow_step(steps.declare_rate(changed(), "hz"), changed())
    assert "self.declare_parameter('hz', 1.0)\n" in rate
    assert "create_timer(1.0 / self.get_parameter('hz').value, self.tick)" in rate
    name = follow_step(steps.declare_name(changed(), "name"), changed())
    assert "self.declare_parameter('name', 'sensor')\n" in name
    assert "info(str(self.get_parameter('name').value))" in name


def test_without_a_source_there_are_only_generic_steps() -> None:
    assert steps.diagnose_rate(changed(), "publish_rate", 8.0) is None
    assert "random.uniform(20.0, 30.0)" in steps.draw_values(None)
    assert steps.add_publisher(Trace("node.py")) == ""
