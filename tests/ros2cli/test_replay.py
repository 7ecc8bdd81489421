"""How the replay classifies outputs: the same, different on purpose, or different without a reason."""

from __future__ import annotations

import pytest

from tests.ros2cli.records import Output, Record
from tests.ros2cli.replay import DELIBERATE, DIFFERS, SAME, compare

PATHS = {"/tmp/x/ws": "$WORKSPACE", "/venv": "$ROS"}


def classify(command: str, recorded: Output, ours: Output, *, ctrl_c_after_s: float | None = None) -> str:
    record = Record("s0_001", "no nodes", command, False, None, ctrl_c_after_s, recorded)
    return compare(record, ours, PATHS).kind


def out(text: str, *, stderr: str = "", code: int = 0) -> Output:
    return Output(text, stderr, code)


@pytest.mark.parametrize(
    ("command", "recorded", "ours"),
    [
        ("ros2 pkg prefix my_package", out("$WORKSPACE/install/my_package\n"), out("/tmp/x/ws/src/my_package\n")),
        (
            "ros2 pkg prefix --share my_package",
            out("$WORKSPACE/install/my_package/share/my_package\n"),
            out("/tmp/x/ws/src/my_package\n"),
        ),
        (
            "ros2 launch my_package nope_launch.py",
            out("", stderr="at '$WORKSPACE/install/my_package/share/my_package'\n", code=1),
            out("", stderr="at '/tmp/log/ros2-overlay._a1/prefix/share/my_package'\n", code=1),
        ),
        (
            "ros2 launch nopkg my_launch.py",
            out("", stderr="searching: ['$WORKSPACE/install/my_package', '$ROS']\"\n", code=1),
            out("", stderr="searching: ['/venv/a', '/tmp/x/prefix']\"\n", code=1),
        ),
        (
            "ros2 topik list",
            out("", stderr="ros2: error: invalid choice: 'topik' (choose from 'component', 'node', 'topic')\n", code=2),
            out("", stderr="ros2: error: invalid choice: 'topik' (choose from 'doctor', 'node', 'topic')\n", code=2),
        ),
        (
            "ros2 topic echo --once -i --csv /t",
            out("1795460564144417103,1795460564144417203,220,None,20.912345\n"),
            out("1795460564144417103,1795460564144417203,17,None,21.112345\n"),
        ),
        (
            "ros2 topic echo --once -i --field data /t",
            out("{'publication_sequence_number': 233, 'reception_sequence_number': None}\n"),
            out("{'publication_sequence_number': 26, 'reception_sequence_number': None}\n"),
        ),
        ("ros2 topic echo --once /rosout", out("msg: 't_1: 20.91 °C'\n"), out("msg: 't_1: 28.3 °C'\n")),
        (
            "ros2 service call /a std_srvs/srv/Trigger",
            out("requester: making request: x\n\nresponse:\ny\n"),
            out("waiting for service to become available...\nrequester: making request: x\n\nresponse:\ny\n"),
        ),
        ("ros2 topic echo --once --csv /rosout", out("1795460564,144417103,20,a\n"), out("1795460430,64489,20,a\n")),
        ("ros2 pkg list", out("launch\nlaunch_ros\nros2cli\nstd_msgs\n"), out("std_msgs\n")),
        (
            "ros2 topic hz /t",
            out("WARNING: topic [/t] does not appear to be published yet\naverage rate: 2.0\n"),
            out("average rate: 1.9\n"),
        ),
    ],
)
def test_differences_of_installation_and_timing_are_ignored(command: str, recorded: Output, ours: Output) -> None:
    assert classify(command, recorded, ours) == SAME


@pytest.mark.parametrize(
    ("command", "recorded", "ours"),
    [
        ("ros2 pkg list", out("my_package\nstd_msgs\n"), out("std_msgs\n")),
        ("ros2 topic hz /t", out("WARNING: topic [/t] does not appear to be published yet\n"), out("")),
        ("ros2 run my_package x", out("", stderr="No executable found\n", code=1), out("", stderr="None\n", code=1)),
        ("ros2 topic echo /t x", out("", stderr="Traceback (most recent call last):\nE: e\n", code=1), out("", code=0)),
    ],
)
def test_anything_else_differs(command: str, recorded: Output, ours: Output) -> None:
    assert classify(command, recorded, ours) == DIFFERS


def test_ours_may_be_more_helpful_with_the_same_exit_code() -> None:
    traceback = out("", stderr="Traceback (most recent call last):\n  File x\nRCLError: bad\n", code=1)
    assert classify("ros2 topic echo 'b d' x", traceback, out("", stderr="bad\n", code=1)) == DELIBERATE
    unknown = out("", stderr="Package 'my_pakage' not found\n", code=1)
    hint = out("", stderr="Package 'my_pakage' not found (is it my_package?)\n", code=1)
    assert classify("ros2 run my_pakage x", unknown, hint) == DELIBERATE


def test_a_deliberate_difference_may_be_limited_to_certain_lines() -> None:
    recorded = out("domain_coordinator\nstd_msgs\n")
    assert classify("ros2 pkg list", recorded, out("std_msgs\n")) == DELIBERATE
    assert classify("ros2 pkg list", recorded, out("")) == DIFFERS

    recorded = out("my_package calculator_client\nmy_package message_stats\n")
    more = "my_package calculator_client\nmy_package courier_driver\nmy_package message_stats\n"
    assert classify("ros2 pkg executables my_package", recorded, out(more)) == DELIBERATE
    assert classify("ros2 pkg executables my_package", recorded, out(more + "another talker\n")) == DIFFERS
    assert classify("ros2 pkg executables my_package", recorded, out("my_package courier_driver\n")) == DIFFERS


def test_ours_may_get_further_until_ctrl_c_but_not_less_far() -> None:
    waits, answers = out("waiting\n", code=2), out("waiting\nrequest\n", code=2)
    assert classify("ros2 service call /a x", waits, answers, ctrl_c_after_s=2.0) == DELIBERATE
    assert classify("ros2 service call /a x", answers, waits, ctrl_c_after_s=2.0) == DIFFERS
    assert classify("ros2 service call /a x", waits, answers) == DIFFERS
    waited = out("waiting for service to become available...\n", code=2)  # ours found it at once
    assert classify("ros2 service call /a x", waited, out("request\n", code=2), ctrl_c_after_s=2.0) == DELIBERATE
