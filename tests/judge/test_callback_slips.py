"""Callbacks that end the program, or never return."""

from __future__ import annotations

import pytest

from tutor.judge.causes import callback_slips
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import NodeFile, node_file


def node(*body: str) -> NodeFile:
    lines = "".join(f"        {line}\n" for line in body)
    return node_file(
        "import sys, time\nimport rclpy\nfrom rclpy.node import Node\n\n\n"
        "class Talker(Node):\n    def __init__(self):\n        super().__init__('talker')\n"
        "        self.timer = self.create_timer(1.0, self.tick)\n\n    def tick(self):\n" + lines
    )


@pytest.mark.parametrize(
    ("statement", "step"),
    [
        ("raise SystemExit", "line 13 becomes: return"),
        ("sys.exit(0)", "line 13 becomes: return"),
        ("rclpy.shutdown()", "line 13 becomes: pass"),
    ],
)
def test_a_callback_that_ends_the_program(statement: str, step: str) -> None:
    found = callback_slips.diagnose_exit_in_callback(node("if not self.on:", f"    {statement}"), "it ended")
    assert found is not None
    assert "it ended: line 13" in found.text
    assert found.hint == step


def test_a_callback_that_only_returns() -> None:
    assert callback_slips.diagnose_exit_in_callback(node("if not self.on:", "    return"), "it ended") is None


def test_a_loop_in_a_callback() -> None:
    program = [Edit(1, 1, "import time")]
    loops = node("while rclpy.ok():", "    time.sleep(1)")
    found = callback_slips.diagnose_loop_in_callback(loops, program)
    assert found is not None
    assert "line 12: tick repeats by itself" in found.text
    assert callback_slips.diagnose_loop_in_callback(node("time.sleep(1)"), program) is None


GROUPED = """\
class Sensors(Node):
    def __init__(self):
        super().__init__('sensors')
        self.group = {}()
        self.create_timer(0.5, self.publish{})
        self.create_timer(2.0, self.measure)


executor = MultiThreadedExecutor()
"""


@pytest.mark.parametrize(
    ("kind", "lines"),
    [
        (
            "ReentrantCallbackGroup",
            {
                "line 5 becomes: self.create_timer(0.5, self.publish, callback_group=self.group)",
                "line 6 becomes: self.create_timer(2.0, self.measure, callback_group=self.group)",
            },
        ),
        (
            "MutuallyExclusiveCallbackGroup",
            {"line 5 becomes: self.create_timer(0.5, self.publish, callback_group=self.group)"},
        ),
    ],
)
def test_a_callback_group_that_no_callback_is_in(kind: str, lines: set[str]) -> None:
    found = callback_slips.diagnose_unused_group(node_file(GROUPED.format(kind, "")))
    assert found is not None
    assert found.text.startswith("line 4: ")
    assert set(found.hint.splitlines()) == lines
    assert callback_slips.diagnose_unused_group(node_file(GROUPED.format(kind, ", self.group"))) is None
