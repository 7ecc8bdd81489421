"""Remarks on what works, but will bite."""

from __future__ import annotations

import pytest

from tutor.judge.check import Check
from tutor.judge.result import Remark
from tutor.mistakes import CATALOGUE, Mistake, remarks

CHECK = Check("any", ())
SPIN = "try:\n    {}\nexcept (KeyboardInterrupt, ExternalShutdownException):\n    pass\n"
REMARKABLE = [entry for entry in CATALOGUE.entries.values() if entry.remark]


def remarks_on(source: str, *known: str) -> tuple[Remark, ...]:
    return remarks({"node.py": source}, CHECK, known)


@pytest.mark.parametrize("entry", REMARKABLE, ids=[entry.id for entry in REMARKABLE])
def test_a_remark_is_made_on_the_bad_example_and_not_on_the_good_one(entry: Mistake) -> None:
    for bad, good in entry.examples:
        (remark,) = remarks_on(bad)
        assert (remark.mistake, remark.file) == (entry.id, "node.py")
        assert remark.line
        assert not remark.text.startswith("line"), "file and line come before it"
        assert "{" not in remark.text
        assert not remarks_on(good)


@pytest.mark.parametrize(
    "source",
    [
        "rclpy.spin(node)\nrclpy.shutdown()",
        f"{SPIN.format('rclpy.spin(node)')}if rclpy.ok():\n    rclpy.shutdown()",
        f"{SPIN.format('rclpy.spin(node)')}try:\n    rclpy.shutdown()\nexcept Exception:\n    pass",
        f"{SPIN.format('rclpy.spin(node)')}with suppress(RCLError):\n    rclpy.shutdown()",
        f"{SPIN.format('rclpy.spin(node)').replace('pass', 'return')}rclpy.shutdown()",
        f"rclpy.init(signal_handler_options=SignalHandlerOptions.NO)\n{SPIN.format('rclpy.spin(node)')}rclpy.shutdown()",
        f"{SPIN.format('call()')}rclpy.shutdown()",
        "self.declare_parameter('volume', 7)",
        "self.declare_parameter('baudrate', 9600)",
        "self.declare_parameter('sample_period', 10)",
        "self.declare_parameter('blink_rate', True)",
        "self.declare_parameter('blink_rate', 2, ParameterDescriptor(dynamic_typing=True))",
        "self.declare_parameters('', [('blink_rate', 2.0), ('volume', 7)])",
        "while not door.wait_for_service(timeout_sec=1.0):\n    print('waiting')",
        "door.wait_for_service(1.0)",
        "while rclpy.ok():\n    horn.publish(Bool())\n    time.sleep(1.0)",
        "while True:\n    horn.publish(Bool())\n    time.sleep(due - time.monotonic())",
        "while True:\n    horn.publish(Bool())\n    rate.sleep()",
        "while True:\n    print('ding')\n    time.sleep(1.0)",
        "self.create_timer(1.0, f)\nwhile True:\n    horn.publish(Bool())\n    time.sleep(1.0)",
    ],
)
def test_what_is_well_done_gets_no_remark(source: str) -> None:
    assert not remarks_on(source)


@pytest.mark.parametrize(
    ("source", "mistake", "line"),
    [
        (f"{SPIN.format('rclpy.spin(node)')}finally:\n    rclpy.shutdown()", "shutdown-after-ctrl-c", 6),
        ("try:\n    rclpy.spin(node)\nexcept KeyboardInterrupt:\n    rclpy.shutdown()", "shutdown-after-ctrl-c", 4),
        ("RATE = 2\nself.declare_parameter('blink_rate', RATE)", "integer-parameter", 2),
        ("self.declare_parameters('', [('blink_hz', 2), ('volume', 7)])", "integer-parameter", 1),
        ("self.declare_parameter('blinkRate', 2)", "integer-parameter", 1),
        ("door.wait_for_service(timeout_sec=None)", "waits-for-a-service", 1),
    ],
)
def test_where_a_remark_is_made(source: str, mistake: str, line: int) -> None:
    assert [(remark.mistake, remark.line) for remark in remarks_on(source)] == [(mistake, line)]


def test_what_a_bonus_criterion_has_told_is_no_remark() -> None:
    source = "door.wait_for_service()"
    assert remarks_on(source)
    assert not remarks_on(source, "waits-for-a-service")


def test_there_are_at_most_two_one_of_a_kind() -> None:
    source = "door.wait_for_service()\ngate.wait_for_service()\n"
    assert len(remarks_on(source)) == 1
    source += "self.declare_parameter('blink_rate', 2)\nwhile True:\n    horn.publish(Bool())\n    time.sleep(1.0)\n"
    assert len(remarks_on(source)) == 2
