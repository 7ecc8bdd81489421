"""A launch argument that names a namespace, on fabricated launches."""

from __future__ import annotations

import pytest

from tests.checks.builders import assert_passed
from tests.exercise.launches import (
    DEFAULT_RUN,
    LISTENER,
    assert_failed,
    endpoint,
    graph,
    in_robot1,
    judge_namespace,
    judge_topic,
    launched,
    pair,
    with_both,
    with_topic,
)

OTHER_TOPIC = with_topic(pair("/news"))
NAMESPACED = in_robot1(pair("/robot1/chatter", namespace="/robot1"))
BOTH = with_both(pair("/robot1/news", namespace="/robot1"))


def test_namespace_passes_if_everything_is_under_it() -> None:
    assert_passed(judge_namespace(DEFAULT_RUN, OTHER_TOPIC, NAMESPACED, BOTH))


def test_a_nested_namespace_passes() -> None:
    namespaced = in_robot1(pair("/robot1/arm/chatter", namespace="/robot1/arm"))
    assert_passed(judge_namespace(DEFAULT_RUN, OTHER_TOPIC, namespaced, BOTH))


def test_the_namespace_is_applied_twice() -> None:
    namespaced = in_robot1(pair("/robot1/robot1/chatter", namespace="/robot1/robot1"))
    both = with_both(pair("/robot1/robot1/news", namespace="/robot1/robot1"))
    assert_failed(
        judge_namespace(DEFAULT_RUN, OTHER_TOPIC, namespaced, both), "namespace applied twice", "/robot1/robot1"
    )
    topic_only = with_both(pair("/robot1/robot1/news", namespace="/robot1"))
    assert_failed(judge_namespace(DEFAULT_RUN, OTHER_TOPIC, NAMESPACED, topic_only), "namespace applied twice")


def test_one_node_has_no_namespace() -> None:
    seen = graph([endpoint("/robot1/chatter", "/robot1/talker")], [endpoint("/chatter", LISTENER)])
    assert_failed(
        judge_namespace(DEFAULT_RUN, OTHER_TOPIC, in_robot1(seen), BOTH),
        "only one node is renamed",
        LISTENER,
    )


def test_no_node_has_the_namespace() -> None:
    seen = in_robot1(pair("/chatter"), command_lines=["talker --ros-args"])
    assert_failed(judge_namespace(DEFAULT_RUN, OTHER_TOPIC, seen, BOTH), "argument without effect")


def test_the_namespace_argument_has_the_wrong_name() -> None:
    seen = in_robot1(pair("/chatter"), command_lines=["talker --ros-args"], declares=("topic", "ns"))
    assert_failed(judge_namespace(DEFAULT_RUN, OTHER_TOPIC, seen, BOTH), "no such launch argument", "ns")


def test_a_name_that_starts_with_the_namespace_is_not_under_it() -> None:
    seen = in_robot1(pair("/robot1chatter", namespace="/robot1x"), command_lines=["talker -r __node:=robot1x"])
    assert_failed(judge_namespace(DEFAULT_RUN, OTHER_TOPIC, seen, BOTH), "wrong names")


def test_an_absolute_topic_is_outside_the_namespace() -> None:
    seen = in_robot1(pair("/chatter", namespace="/robot1"), command_lines=["talker --ros-args -r chatter:=/chatter"])
    assert_failed(judge_namespace(DEFAULT_RUN, OTHER_TOPIC, seen, BOTH), "absolute topic", "/chatter")


def test_a_remapping_from_an_absolute_name_fails_in_a_namespace() -> None:
    both = with_both(
        pair("/robot1/chatter", namespace="/robot1"), command_lines=["talker -r __ns:=/robot1 -r /chatter:=news"]
    )
    assert_failed(judge_namespace(DEFAULT_RUN, OTHER_TOPIC, NAMESPACED, both), "remapping without effect", "/chatter")


def test_a_topic_argument_that_is_never_used_is_left_to_the_topic_criterion() -> None:
    both = with_both(pair("/robot1/chatter", namespace="/robot1"))
    assert_passed(judge_namespace(DEFAULT_RUN, with_topic(pair("/chatter")), NAMESPACED, both))


def test_unconnected_nodes_may_pass_in_a_namespace() -> None:
    default_run, namespaced = launched(pair("/a", "/b")), in_robot1(pair("/robot1/a", "/robot1/b", namespace="/robot1"))
    assert_passed(judge_namespace(default_run, OTHER_TOPIC, namespaced, BOTH))


@pytest.mark.parametrize("home", ["/demo", "/robot1"])
def test_the_default_namespace_need_not_be_empty(home: str) -> None:
    default_run, other_topic = (
        launched(pair(f"{home}/chatter", namespace=home)),
        with_topic(pair(f"{home}/news", namespace=home)),
    )
    another = launched(pair("/robot2/chatter", namespace="/robot2"), arguments={"namespace": "robot2"})
    assert_passed(judge_topic(default_run, other_topic))
    assert_passed(judge_namespace(default_run, other_topic, NAMESPACED, BOTH, another if home == "/robot1" else None))


@pytest.mark.parametrize("home", ["/demo", "/robot1"])
def test_a_namespace_that_never_changes_fails(home: str) -> None:
    default_run, other_topic = (
        launched(pair(f"{home}/chatter", namespace=home)),
        with_topic(pair(f"{home}/news", namespace=home)),
    )
    namespaced = in_robot1(pair(f"{home}/chatter", namespace=home))
    another = launched(pair(f"{home}/chatter", namespace=home), arguments={"namespace": "robot2"})
    verdict = judge_namespace(default_run, other_topic, namespaced, BOTH, another if home == "/robot1" else None)
    assert_failed(verdict, "argument without effect")
