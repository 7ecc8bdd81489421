"""The step for a process that does not end well on Ctrl+C fits the lines that the learner's file has."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.checks.made import FOLDER, trace
from tutor.judge import closing
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame


def node(source: str) -> Trace:
    return replace(trace(), sources={"node.py": source})


def spin(line: int) -> Frame:
    return Frame(f"{FOLDER}/node.py", line, "main", "rclpy.spin(node)")


BOTH = "except (KeyboardInterrupt, ExternalShutdownException):"
IMPORT = ", with from rclpy.executors import ExternalShutdownException at the top"


@pytest.mark.parametrize(
    ("source", "line", "step"),
    [
        (
            "rclpy.spin(node)\nrclpy.shutdown()",
            1,
            f"in place of line 1: try: rclpy.spin(node) / {BOTH} pass / finally: rclpy.try_shutdown(){IMPORT}; and "
            "write rclpy.try_shutdown() in place of rclpy.shutdown() in line 2",
        ),
        (
            "rclpy.spin(node)\nrclpy.try_shutdown()",
            1,
            f"in place of line 1: try: rclpy.spin(node) / {BOTH} pass{IMPORT}",
        ),
        ("try:\n  rclpy.spin(node)\nexcept KeyboardInterrupt:\n  pass", 2, f"line 3 becomes: {BOTH}{IMPORT}"),
        (
            "from rclpy.executors import ExternalShutdownException\ntry:\n  rclpy.spin(node)\n"
            "except ExternalShutdownException:\n  pass",
            3,
            f"line 4 becomes: {BOTH}",
        ),
        (
            "try:\n  rclpy.spin(node)\nfinally:\n  rclpy.try_shutdown()",
            2,
            "write above the finally: of the try block that begins in line 1, with the same indentation: "
            f"{BOTH} pass{IMPORT}",
        ),
        (
            "try:\n  rclpy.spin(node)\nexcept ValueError:\n  pass",
            2,
            f"write above line 3, with the same indentation: {BOTH} pass{IMPORT}",
        ),
        ("def broken(", 1, f"in place of line 1: try: rclpy.spin(node) / {BOTH} pass / finally: rclpy.try_shutdown()"),
    ],
)
def test_catching_what_ends_a_spin(source: str, line: int, step: str) -> None:
    assert closing.catching(node(source), spin(line)).startswith(step)


def test_a_thread_that_spins_gets_a_function_that_catches() -> None:
    assert "Thread(target=spin)" in closing.catching(node("Thread(target=executor.spin).start()"), None)


@pytest.mark.parametrize(
    ("source", "step"),
    [
        ("rclpy.shutdown()\nx\nrclpy.shutdown()", "in place of rclpy.shutdown() in lines 1, 3"),
        ("executor.shutdown()\nrclpy.shutdown()", "in line 2"),
        ("", "write rclpy.try_shutdown() in place of rclpy.shutdown()"),
    ],
)
def test_shutting_down_once(source: str, step: str) -> None:
    assert closing.shutting_down(node(source)).endswith(step)


@pytest.mark.parametrize(
    ("source", "step"),
    [
        ("signal.signal(signal.SIGINT, stop)", "delete line 1, signal.signal(signal.SIGINT, stop)"),
        (
            "while True:\n  try:\n    rclpy.spin(n)\n  except KeyboardInterrupt:\n    pass",
            "write break in place of line 5",
        ),
        ("while rclpy.ok():\n  try:\n    rclpy.spin(n)\n  except:\n    pass", "write break in place of line 5"),
        ("while True:\n  work()", "line 1 becomes: while rclpy.ok():"),
        ("Thread(target=work).start()", "give the thread of line 1 daemon=True"),
        ("rclpy.spin(node)", "let KeyboardInterrupt end the program"),
    ],
)
def test_letting_ctrl_c_through(source: str, step: str) -> None:
    assert closing.letting_go(node(source)).startswith(step)


def test_each_step_stands_in_a_line_of_its_own() -> None:
    """What follows a line of code must not look like a part of it."""
    said = closing.letting_go(node("Thread(target=work).start()\nwhile True:\n  work()"))
    assert said.splitlines()[0] == "line 2 becomes: while rclpy.ok():"
    assert said.splitlines()[1].startswith("give the thread of line 1 daemon=True")


def test_the_exit_code() -> None:
    assert "in line 2" in closing.returning(node("import sys\nsys.exit(3)"))
    assert "return normally" in closing.returning(node("pass"))


def test_leaving_out_what_needs_ros() -> None:
    line = Frame(f"{FOLDER}/node.py", 7, "main", "node.get_logger().info('bye')")
    assert closing.leaving_out(line).startswith("leave out line 7, node.get_logger().info('bye')")
    assert "stop before that" in closing.leaving_out(spin(7))
    broken = Frame(f"{FOLDER}/node.py", 9, "slow_add", "raise RuntimeError('interrupted')")
    assert closing.leaving_out(broken).startswith("write return in place of line 9")
