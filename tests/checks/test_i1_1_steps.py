"""I1.1: the next step in the words of the learner's own file."""

from __future__ import annotations

import pytest

from checks.i1_1 import steps
from tutor.judge.reading import UNREAD, Source

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
        (changed(("random.uniform(20.0, 30.0)", "self.value")), "line 17: msg.data = random.uniform(20.0, 30.0)"),
        (changed(("        msg =", "        random.seed(1)\n        msg =")), "remove line 16, random.seed(1)"),
        (
            changed(("        msg.data = random.uniform(20.0, 30.0)\n", ""), ("Float64()", "Float64(data=self.value)")),
            "line 16: msg = Float64(data=random.uniform(20.0, 30.0))",
        ),
        (changed(("import random\n", "")), "\nat the top of the file: import random"),
    ],
)
def test_draw(source: Source, step: str) -> None:
    assert step in str(steps.draw(source))


def test_an_int_becomes_a_float() -> None:
    assert steps.as_float(changed(("random.uniform(20.0, 30.0)", "25"))) == "line 17: msg.data = float(25)"


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (
            changed(
                (
                    "self.rate = self.get_parameter('publish_rate').value",
                    "self.rate = int(self.get_parameter('publish_rate').value)",
                )
            ),
            "rate made a whole number",
            "line 10: self.rate = float(self.get_parameter('publish_rate').value)",
        ),
        (changed(("1.0 / self.rate", "1 // self.rate")), "period made a whole number", "1 / self.rate"),
        (
            changed(("1.0 / self.rate", "1000.0 / self.rate")),
            "wrong timer period",
            "line 13: self.timer = self.create_timer(1.0 / self.rate, self.tick)",
        ),
        (
            changed(("1.0 / self.rate", "1.0")),
            "parameter ignored",
            "line 13: self.timer = self.create_timer(1.0 / self.rate, self.tick)",
        ),
        (
            changed(("        msg =", "        self.create_timer(1.0 / self.rate, self.tick)\n        msg =")),
            "wrong rate",
            "remove line 16",
        ),
        (
            changed(("        self.timer =", "        self.create_timer(1.0, self.tick)\n        self.timer =")),
            "wrong rate",
            "remove line 13: self.create_timer(1.0, self.tick)",
        ),
        (
            changed(("        self.timer =", "        self.rate = 1.0\n        self.timer =")),
            "value overwritten by the node",
            "remove line 13",
        ),
        (
            changed(("get_parameter('publish_rate')", "get_parameter_or('rate', None)")),
            "parameter ignored",
            "self.get_parameter('publish_rate').value",
        ),
    ],
)
def test_rate(source: Source, cause: str, step: str) -> None:
    found = steps.rate(source, "publish_rate")
    assert found is not None
    assert found.name == cause, found
    assert step in found.hint


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (changed((".info(", ".debug(")), "logged at DEBUG", "line 19: self.get_logger().info(f'"),
        (
            changed(("info(f'", "info('")),
            "no f in front of the text",
            "line 19: self.get_logger().info(f'{self.sensor}",
        ),
        (
            changed(("{self.sensor}: ", "")),
            "parameter ignored",
            "begin tick (line 15) with: self.get_logger().info(self.get_parameter('sensor_name').value)",
        ),
    ],
)
def test_name_logged(source: Source, cause: str, step: str) -> None:
    found = steps.name_logged(source, "sensor_name")
    assert found is not None
    assert found.name == cause
    assert step in found.hint


def test_nothing_is_said_of_what_is_right() -> None:
    assert steps.rate(Source(NODE), "publish_rate") is None
    for step in (steps.rate, steps.name_logged):
        assert step(UNREAD, "publish_rate") is None
    assert steps.draw(UNREAD) is None
