"""Of which nodes it is certain that all log messages come at the start or on each message."""

from __future__ import annotations

import pytest

from tutor.source.log_calls import logs_the_same_on_each_message

NODE = """\
import random

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class Sensor(Node):
    def __init__(self):
        super().__init__('sensor')
        self.name = self.declare_parameter('sensor_name', 'lab').value
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0, self.on_timer)
        self.count = 0

    def on_timer(self):
        message = Float64(data=random.uniform(20.0, 30.0))
        self.publisher.publish(message)
        self.get_logger().info(f'{message.data}')


def main():
    rclpy.init()
    node = Sensor()
    node.get_logger().info('up')
    rclpy.spin(node)
"""
LOG = "        self.get_logger().info(f'{message.data}')\n"


def changed(*pairs: tuple[str, str]) -> dict[str, str]:
    """The node with each of these texts replaced."""
    code = NODE
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return {"temperature_publisher.py": code}


@pytest.mark.parametrize(
    "pairs",
    [
        (),
        ((LOG, ""),),
        ((LOG, LOG * 2),),
        (("        self.count = 0\n", "        if self.name:\n            self.get_logger().info('named')\n"),),
    ],
)
def test_a_plain_node_logs_the_same_on_each_message(pairs: tuple[tuple[str, str], ...]) -> None:
    assert logs_the_same_on_each_message(changed(*pairs))


@pytest.mark.parametrize(
    "pairs",
    [
        ((LOG, f"        self.count += 1\n        if self.count % 10 == 0:\n    {LOG}"),),
        ((LOG, f"        if self.count < 10:\n            return\n{LOG}"),),
        ((LOG, LOG.replace("}')", "}', throttle_duration_sec=5.0)")),),
        ((LOG, LOG.replace("}')", "}', skip_first=True)")),),
        ((LOG, LOG.replace("f'{message.data}'", "self.name if self.count > 9 else 'none'")),),
        (("        self.count = 0\n", "        self.other = self.create_timer(10.0, self.on_timer)\n"),),
        (
            ("        self.count = 0\n", "        self.log = self.get_logger()\n"),
            (LOG, "        self.log.info('a')\n" * 2),
        ),
        (("import random\n", "import random\nimport threading\n"),),
        (("import random\n", "import random\nimport time\n"),),
        (("    def on_timer", "    def report(self):\n        self.get_logger().info(self.name)\n\n    def on_timer"),),
        (("rclpy.spin(node)", "exec('rclpy.spin(node)')"),),
        (("self.create_timer(1.0, self.on_timer)", "self.create_timer(1.0, lambda: self.on_timer())"),),
    ],
)
def test_a_node_that_may_log_something_else_later_is_waited_for(pairs: tuple[tuple[str, str], ...]) -> None:
    assert not logs_the_same_on_each_message(changed(*pairs))


def test_nothing_is_certain_of_several_files_or_of_code_that_python_cannot_read() -> None:
    assert not logs_the_same_on_each_message(changed() | {"other.py": "x = 1"})
    assert not logs_the_same_on_each_message({"temperature_publisher.py": "def f(:"})
    assert not logs_the_same_on_each_message({})
