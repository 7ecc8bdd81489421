"""I1.1: the whole program, in the learner's names: the step that is left where no smaller one helps."""

from __future__ import annotations

import ast

from checks.i1_1.facts import HIGHEST, LOWEST, SUGGESTED_NAME, SUGGESTED_RATE, TOPIC
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import NodeFile, argument
from tutor.judge.rewriting.whole import MAIN, names_of, rewrite_file

_PROGRAM = """\
import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class {node_class}(Node):
    def __init__(self):
        super().__init__('{node}')
        self.declare_parameter('{rate}', 1.0)
        self.declare_parameter('{name}', {default!r})
        self.{publisher} = self.create_publisher(Float64, '{topic}', 10)
        self.{timer} = self.create_timer(1.0 / self.get_parameter('{rate}').value, self.{tick})

    def {tick}(self):
        message = Float64()
        message.data = random.uniform({lowest}, {highest})
        self.{publisher}.publish(message)
        self.get_logger().info(f'{{self.get_parameter("{name}").value}}: {{message.data:.2f}}')
"""


def whole_program(file: NodeFile) -> list[Edit]:
    """The node, its callback and main(), as a whole."""
    rate, _ = _parameter(file, ("rate", "freq", "hz"), float, SUGGESTED_RATE, 1.0)
    name, default = _parameter(file, ("name", "sensor"), str, SUGGESTED_NAME, "sensor")
    asked = {"rate": rate, "name": name, "default": default, "lowest": LOWEST, "highest": HIGHEST, "topic": TOPIC}
    return rewrite_file(file, (_PROGRAM + MAIN).format(**vars(names_of(file, "temperature_publisher")), **asked))


def _parameter(file: NodeFile, words: tuple[str, ...], kind: type, name: str, default: object) -> tuple[str, object]:
    """The parameter that the file declares for this, by a word in its name, with its default; else the usual one."""
    for call in file.calls("declare_parameter"):
        match argument(call, 0, "name"), argument(call, 1, "value"):
            case ast.Constant(value=str() as told), given if told.isidentifier() and any(
                each in told for each in words
            ):
                value = given.value if isinstance(given, ast.Constant) else default
                is_number = isinstance(value, int | float) and not isinstance(value, bool)
                if is_number if kind is float else isinstance(value, kind):
                    return told, value
    return name, default
