"""Ctrl+C on an active lifecycle node, judged on made-up facts."""

from __future__ import annotations

from tests.checks.builders import assert_failed, assert_passed, assert_skipped, ending, exited, trace
from tutor.exercise import (
    Activates,
    EndsCleanly,
    Lifecycle,
    Parameter,
    Program,
    SetsRate,
    Topic,
    WhileActive,
    check,
)
from tutor.exercise.ends_cleanly import EndedRun

IMAGES = Topic("/images", "std_msgs/msg/String")
CAMERA = Lifecycle("/camera", IMAGES, Parameter("rate", 5.0, SetsRate(IMAGES)))


def test_ctrl_c_is_pressed_on_a_start_of_its_own_while_the_node_is_active() -> None:
    activates = Activates("activates", CAMERA)
    active = WhileActive(Program("node.py"), CAMERA)
    ends = check("t1", Program("node.py"), activates, EndsCleanly("busy", active, activates, bonus=True))
    criterion = ends.criteria[-1]
    assert criterion.facts == (active,)
    assert_passed(criterion.judge(EndedRun(trace(), ending())))
    assert_failed(criterion.judge(EndedRun(trace(), ending(still_running=True))), "does not end", check=ends)
    assert_skipped(criterion.judge(EndedRun(trace(exit=exited(1)), None)), "`activates` shows why")
