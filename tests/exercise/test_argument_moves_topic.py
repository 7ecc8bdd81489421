"""A launch argument that names a topic, on fabricated launches."""

from __future__ import annotations

from dataclasses import replace

import pytest

from checks.i2_2_launch_file import CHECK
from tests.checks.builders import assert_passed, exited, explained
from tests.exercise.launches import (
    DEFAULT_RUN,
    ERROR,
    LISTENER,
    OWN_LINE,
    TALKER,
    assert_failed,
    endpoint,
    graph,
    judge_topic,
    launched,
    pair,
    with_program,
    with_topic,
)
from tutor.ros_model import Graph


def test_topic_passes_if_both_nodes_use_it() -> None:
    assert_passed(judge_topic(DEFAULT_RUN, with_topic(pair("/news"))))


def test_other_topics_may_stay_the_same() -> None:
    extra_publisher, extra_subscription = endpoint("/beat", "/heart"), endpoint("/beat", "/watchdog")
    default_run = graph(
        [endpoint("/chatter", TALKER), extra_publisher], [endpoint("/chatter", LISTENER), extra_subscription]
    )
    seen = graph([endpoint("/news", TALKER), extra_publisher], [endpoint("/news", LISTENER), extra_subscription])
    assert_passed(judge_topic(launched(default_run), with_topic(seen)))


def test_the_default_topic_must_not_be_used_any_more() -> None:
    seen = graph([endpoint("/news", TALKER), endpoint("/chatter", TALKER)], [endpoint("/news", LISTENER)])
    assert_failed(judge_topic(DEFAULT_RUN, with_topic(seen)), "default topic still used", TALKER, "/chatter")


def test_a_node_that_drops_its_ros_arguments_is_blamed() -> None:
    program = "def main():\n    rclpy.init(args=remove_ros_args(sys.argv))\n    rclpy.spin(Node('ear'))\n"
    for verdict in (
        judge_topic(DEFAULT_RUN, with_program(with_topic(pair("/news", "/chatter")), program)),
        judge_topic(DEFAULT_RUN, with_program(with_topic(pair("/chatter")), program)),
    ):
        assert_failed(verdict, "arguments left out", "ear.py, line 2")


def test_a_namespace_of_its_own_is_named() -> None:
    seen = graph([endpoint("/news", TALKER)], [endpoint("/opr/news", "/opr/listener")])
    assert_failed(judge_topic(DEFAULT_RUN, with_topic(seen)), "namespace of its own", "/opr/listener")


@pytest.mark.parametrize(("more", "is_named"), [("", True), (", condition=IfCondition(plain)", False)])
def test_a_launch_file_that_sets_the_argument_itself(more: str, is_named: bool) -> None:
    line = f"SetLaunchConfiguration('topic', 'chatter'{more}),"
    source = f"description = LaunchDescription([\n    talker,\n    {line}\n])\n"
    seen = with_topic(pair("/news", "/chatter"))
    seen = replace(seen, trace=replace(seen.trace, sources={"my_launch.py": source}))
    verdict = judge_topic(DEFAULT_RUN, seen)
    assert ("argument overwritten" in explained(verdict, CHECK).cause) is is_named


@pytest.mark.parametrize(
    ("more", "read", "is_named"),
    [("", "target", True), (", scoped=False", "target", False), ("", "other", False)],
)
def test_a_setting_that_a_group_takes_back(more: str, read: str, is_named: bool) -> None:
    group = f"GroupAction([SetLaunchConfiguration('target', topic)]{more})"
    source = f"description = LaunchDescription([\n    {group},\n    talker(LaunchConfiguration('{read}')),\n])\n"
    seen = with_topic(pair("/chatter", "/chatter"))
    seen = replace(seen, trace=replace(seen.trace, sources={"my_launch.py": source}))
    verdict = judge_topic(DEFAULT_RUN, seen)
    assert ("setting lost with its group" in explained(verdict, CHECK).cause) is is_named


@pytest.mark.parametrize(("sent", "taken"), [("/news", "/chatter"), ("/chatter", "/news")])
def test_one_node_is_not_remapped(sent: str, taken: str) -> None:
    command_lines = ["talker --ros-args -r chatter:=news", "listener --ros-args"]
    verdict = judge_topic(DEFAULT_RUN, with_topic(pair(sent, taken), command_lines=command_lines))
    assert_failed(verdict, "only one node is renamed", "/chatter")


def test_a_suffix_is_added_to_the_topic() -> None:
    seen = with_topic(pair("/news_data"), command_lines=["talker --ros-args -r chatter:=news_data"])
    assert_failed(judge_topic(DEFAULT_RUN, seen), "wrong topic", "/news_data", "added")


@pytest.mark.parametrize(
    ("command_lines", "declares", "cause"),
    [
        (["talker --ros-args -r chatter:=chatter"], ("topik", "namespace"), "no such launch argument"),
        (["talker --ros-args"], ("namespace",), "no such launch argument"),
        (["talker --ros-args -r chatter:=my_topic"], ("topic",), "argument without effect"),
        (["talker --ros-args -r topic:=news"], ("topic",), "remapping without effect"),
        (["talker --ros-args -r news:=chatter"], ("topic",), "remapping the wrong way round"),
        (["talker --ros-args -r chatter:=x -r chatter:=news"], ("topic",), "remapping without effect"),
    ],
)
def test_causes_of_a_topic_that_no_node_uses(command_lines: list[str], declares: tuple[str, ...], cause: str) -> None:
    seen = with_topic(
        pair("/chatter"), command_lines=["ros2 launch my_launch.py topic:=news", *command_lines], declares=declares
    )
    assert_failed(judge_topic(DEFAULT_RUN, seen), cause)


def test_a_remapping_of_another_node_does_not_show_that_the_name_is_unused() -> None:
    swapped = pair("/news")
    swapped = replace(swapped, subscriptions=(replace(swapped.subscriptions[0], topic="/news/bot"),))
    seen = with_topic(swapped, command_lines=["talker -r chatter:=news", "listener -r __ns:=/news -r chatter:=bot"])
    assert_failed(judge_topic(DEFAULT_RUN, seen), "only one node is renamed")


def test_a_crash_that_only_the_argument_causes_is_reported() -> None:
    seen = with_topic(Graph(), out=f"{ERROR}'NoneType' object has no attribute 'x'\n{OWN_LINE}", exit=exited(1))
    assert_failed(judge_topic(DEFAULT_RUN, seen), "unhandled exception", "line 9")


def test_no_messages_on_the_topic() -> None:
    assert_failed(judge_topic(DEFAULT_RUN, with_topic(pair("/news"), messages=0)), "wrong names", "nothing is sent")


def test_a_publisher_that_never_publishes_is_not_blamed_here() -> None:
    assert_passed(judge_topic(launched(pair("/chatter"), messages=0), with_topic(pair("/news"), messages=0)))


def test_messages_of_a_type_that_we_cannot_subscribe_to_count_as_sent() -> None:
    seen = with_topic(pair("/news"), messages=0, hidden=frozenset({"/news"}))
    assert_passed(judge_topic(DEFAULT_RUN, seen))


def test_a_topic_that_only_one_node_uses_in_a_default_namespace_fails() -> None:
    default_run = launched(pair("/demo/chatter", namespace="/demo"))
    seen = with_topic(pair("/demo/news", "/demo/chatter", namespace="/demo"))
    assert_failed(judge_topic(default_run, seen), "only one node is renamed")
