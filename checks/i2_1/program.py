"""I2.1: a rewrite of the whole program that keeps the learner's names: the step of last resort."""

from __future__ import annotations

from checks.i2_1.facts import DEFAULTS, ENABLED, PREFIX, RATE, TOPIC
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.rewriting.whole import MAIN, names_of, rewrite_file

_PROGRAM = """\
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class {node_class}(Node):
    def __init__(self):
        super().__init__('{node}')
        self.declare_parameter('{prefix}', {defaults[0]!r})
        self.declare_parameter('{rate}', {defaults[1]!r})
        self.declare_parameter('{enabled}', {defaults[2]!r})
        rate = self.get_parameter('{rate}').value
        if rate <= 0.0:
            self.get_logger().fatal('{rate} must be > 0')
            raise SystemExit(1)
        self.{counter} = 0
        self.{publisher} = self.create_publisher(String, '{topic}', 10)
        self.{timer} = self.create_timer(1.0 / rate, self.{tick})
        self.add_on_set_parameters_callback(self.{check})
        self.add_post_set_parameters_callback(self.follow_parameters)

    def {check}(self, params):
        for p in params:
            if p.name == '{rate}' and p.value <= 0.0:
                return SetParametersResult(successful=False, reason='{rate} must be > 0')
        return SetParametersResult(successful=True)

    def follow_parameters(self, params):
        for p in params:
            if p.name == '{rate}':
                self.destroy_timer(self.{timer})
                self.{timer} = self.create_timer(1.0 / p.value, self.{tick})

    def {tick}(self):
        if not self.get_parameter('{enabled}').value:
            return
        prefix = self.get_parameter('{prefix}').value
        self.{publisher}.publish(String(data=f'{{prefix}} {{self.{counter}}}'))
        self.{counter} += 1
"""


def whole_program(file: NodeFile) -> list[Edit]:
    """Replace the node, its callbacks and main()."""
    own = vars(names_of(file, "parameterized_publisher"))
    defaults = [value for _, value in DEFAULTS.values()]
    asked = {"prefix": PREFIX, "rate": RATE, "enabled": ENABLED, "topic": TOPIC.lstrip("/"), "defaults": defaults}
    return rewrite_file(file, (_PROGRAM + MAIN).format(**own, **asked))
