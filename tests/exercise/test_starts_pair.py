"""What a launch file starts, on fabricated launches."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.checks.builders import FOLDER, assert_passed, exited, lines
from tests.exercise.launches import (
    DEAD,
    DEFAULT_RUN,
    ERROR,
    LISTENER,
    LOADING,
    OWN_LINE,
    TALKER,
    assert_failed,
    endpoint,
    graph,
    judge_starts,
    launched,
    pair,
)
from tutor.errors import NeedsInstalledRos
from tutor.exercise.launch_run import LaunchRun
from tutor.judge.trace import Trace
from tutor.ros_model import Graph

ONE = LOADING.replace("multiple exceptions", "exception")
FORMAT = " - InvalidFrontendLaunchFileError: The launch file may have a syntax error, or its format is unknown"
UNCLOSED, NULL_BYTE = "import launch\n\n\nlaunch.main(\n", "import launch\n\n\n\0launch.main()\n"


def test_a_talker_and_a_listener_pass() -> None:
    assert_passed(judge_starts(DEFAULT_RUN))


def test_nodes_on_any_topics_pass() -> None:
    assert_passed(judge_starts(launched(pair("/chatter", "/chater"))))


def test_a_node_whose_namespace_begins_with_an_underscore_counts() -> None:
    seen = graph([endpoint("/chatter", TALKER)], [endpoint("/_opr/chatter", "/_opr/listener")])
    assert_passed(judge_starts(launched(seen)))


def test_subscriptions_of_ros_itself_do_not_make_a_subscriber() -> None:
    seen = graph(
        [endpoint("/chatter", TALKER)],
        [endpoint(topic, LISTENER) for topic in ("/clock", "/parameter_events", "/fibonacci/_action/feedback")],
    )
    assert_failed(judge_starts(launched(seen)), "one side missing", TALKER)


def test_one_node_is_not_two() -> None:
    seen = graph([endpoint("/chatter", "/both")], [endpoint("/chatter", "/both")])
    assert_failed(judge_starts(launched(seen)), "one side missing")


def test_two_nodes_of_the_same_name_are_two() -> None:
    seen = Graph(("/both", "/both"), (endpoint("/chatter", "/both"),), (endpoint("/chatter", "/both"),))
    assert_passed(judge_starts(launched(seen)))


@pytest.mark.parametrize(
    ("out", "cause", "words"),
    [
        (f"{ERROR}\"package 'demo' not found, searching: ['/opt/ros/jazzy']\"", "package not found", "demo"),
        (f"{ERROR}executable 'talk' not found on the libexec directory '/x'", "executable not found", "'talk'"),
        (f"{LOADING} - NameError: name 'LogInfo' is not defined\n{OWN_LINE}", "unhandled exception", "line 9"),
        (
            f"{LOADING} - InvalidPythonLaunchFileError: launch file at 'x' does not contain the required function "
            "'generate_launch_description()'",
            "no generate_launch_description",
            "function",
        ),
        (f"{ERROR}'NoneType' object has no attribute 'entities'", "nothing returned", "LaunchDescription"),
        (f"{ERROR}something else", "error in the launch", "something else"),
        (DEAD, "unhandled exception", "hearer.py, line 7"),
        ("", "nothing to launch", "LaunchDescription"),
    ],
)
def test_causes_of_a_launch_that_starts_nothing(out: str, cause: str, words: str) -> None:
    seen = launched(Graph(), out=out, exit=exited(1, after_s=0.4))
    assert_failed(judge_starts(seen), cause, words)


@pytest.mark.parametrize(
    ("out", "source", "cause", "words"),
    [
        (f"{LOADING} - SyntaxError: '(' was never closed (my_launch.py, line 4)", UNCLOSED, "syntax error", "main()"),
        (f"{LOADING} - IndentationError: unexpected indent (my_launch.py, line 4)", "", "syntax error", "line 4"),
        (
            f"{ONE} - SyntaxError: source code string cannot contain null bytes",
            NULL_BYTE,
            "syntax error",
            "line 4",
        ),
        (f"{LOADING} - ValueError: not yet", "", "unhandled exception", "ValueError: not yet"),
    ],
)
def test_causes_without_the_traceback_that_an_installed_ros_omits(
    out: str, source: str, cause: str, words: str
) -> None:
    seen = launched(Graph(), out=f"{out}\n{FORMAT}", exit=exited(1, after_s=0.4))
    seen = replace(seen, trace=replace(seen.trace, sources={"my_launch.py": source}))
    assert_failed(judge_starts(seen), cause, words)


def test_a_traceback_is_read_from_interleaved_streams() -> None:
    mixed = lines(f'  File "{FOLDER}/my_launch.py", line 3\n    ])\n    ^')
    mixed += lines(" - InvalidFrontendLaunchFileError: The launch file may have a syntax error", "stdout")
    mixed += lines("SyntaxError: closing parenthesis ']' does not match")
    trace = Trace("my_launch.py", FOLDER, output=(*lines(LOADING, "stdout"), *mixed), exit=exited(1))
    assert_failed(judge_starts(LaunchRun(trace)), "syntax error", "line 3")


def test_a_command_that_needs_an_installed_ros_is_not_the_learners_fault() -> None:
    says = "[ros2-1] ros2: `ros2 topic` needs an installed ROS 2; this ros2 knows: launch, run"
    out = f"{says}\n[ERROR] [ros2-1]: process has died [pid 12, exit code 2, cmd 'ros2 topic pub /chatter']"
    with pytest.raises(NeedsInstalledRos, match="ros2 topic"):
        judge_starts(launched(Graph(nodes=(LISTENER,)), out=out))


def test_a_default_that_is_no_valid_name() -> None:
    raised = (
        "rclpy._rclpy_pybind11.RCLError: failed to initialize rcl: Couldn't parse remap rule: '-r chatter:=my-topic'."
    )
    seen = launched(Graph(), out=f"[talker-1] {raised}")
    assert_failed(judge_starts(seen), "invalid name", "my-topic", "digits")


def test_a_substitution_in_an_f_string() -> None:
    broken = (
        "[talker-1] Couldn't parse remap rule: '-r chatter:=<launch.substitutions.launch_configuration.LaunchConfig"
    )
    out = f"{broken}uration object at 0x7f1>'\n{DEAD.replace('hearer-2', 'talker-1')}"
    assert_failed(
        judge_starts(launched(Graph(), out=out)), "substitution made text too early", "before its value is known"
    )


def test_an_action_that_needs_an_installed_ros_is_not_the_learners_fault() -> None:
    says = "launch_ros.actions.LifecycleNode is not supported by the launch files that run without an installed ROS 2"
    broken = launched(Graph(), out=f"{ERROR}{says}; it works where ROS 2 is installed and sourced", exit=exited(1))
    with pytest.raises(NeedsInstalledRos, match=r"^launch_ros\.actions\.LifecycleNode is not supported"):
        judge_starts(broken)
