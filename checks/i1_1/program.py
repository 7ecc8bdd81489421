"""I1.1: a rewrite of the whole program that keeps the learner's names: the step of last resort."""

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
    """Replace the node, its callback and main()."""
    rate, _ = _find_parameter(file, ("rate", "freq", "hz"), float, SUGGESTED_RATE, 1.0)
    name, default = _find_parameter(file, ("name", "sensor"), str, SUGGESTED_NAME, "sensor")
    asked = {"rate": rate, "name": name, "default": default, "lowest": LOWEST, "highest": HIGHEST, "topic": TOPIC}
    return rewrite_file(file, (_PROGRAM + MAIN).format(**vars(names_of(file, "temperature_publisher")), **asked))


def _find_parameter(
    file: NodeFile, words: tuple[str, ...], kind: type, name: str, default: object
) -> tuple[str, object]:
    """Find a declared parameter whose name contains one of `words`; return its name and default.

    Return `name` and `default` if there is none of this kind.
    """
    for call in file.calls("declare_parameter"):
        match argument(call, 0, "name"), argument(call, 1, "value"):
            case ast.Constant(value=str() as declared), given if declared.isidentifier() and any(
                word in declared for word in words
            ):
                value = given.value if isinstance(given, ast.Constant) else default
                is_number = isinstance(value, int | float) and not isinstance(value, bool)
                if is_number if kind is float else isinstance(value, kind):
                    return declared, value
    return name, default
