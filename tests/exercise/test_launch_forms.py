"""Launch forms as another exercise uses them: a lamp, whose arguments have other names."""

from __future__ import annotations

import pytest

from tests.checks.builders import assert_failed, assert_passed, assert_skipped, ending, exited, explained, judge_of
from tests.exercise.launches import endpoint, graph, launched, pair
from tutor.exercise import (
    ArgumentMovesNamespace,
    ArgumentMovesTopic,
    CallsAll,
    Contains,
    EndsCleanly,
    Form,
    LaunchFile,
    PairCommunicates,
    Program,
    Publishes,
    StartsPair,
    Topic,
    check,
)
from tutor.exercise.client_run import ClientRun
from tutor.exercise.ends_cleanly import StartAndEnd
from tutor.exercise.launch_run import Launch, LaunchRun, LaunchWith
from tutor.ros_model import Graph

LAMP = LaunchFile("lamp_launch.py")
STATE = Topic("/state", "std_msgs/msg/String")

TOPIC = ArgumentMovesTopic("topic", "state_topic")
DEFAULT_RUN = launched(pair("/state"))


def in_house(seen: Graph, name: str = "house", **more: str) -> LaunchRun:
    return launched(seen, arguments={"robot": name, **more}, declares=("state_topic", "robot"))


def moved(seen: Graph) -> LaunchRun:
    return launched(seen, arguments={"state_topic": "news"}, declares=("state_topic", "robot"))


@pytest.mark.parametrize(
    "others",
    [
        (),
        (StartsPair("starts"),),
        (PairCommunicates("communicates"),),
        (TOPIC,),
        (ArgumentMovesNamespace("namespace", "robot"),),
        (StartsPair("starts", bonus=True),),
    ],
)
def test_the_end_of_a_launch_file_is_that_of_a_launch(others: tuple[Form, ...]) -> None:
    made = check("t1.3", LAMP, *others, EndsCleanly("end"))
    assert made.criteria[-1].facts == (Launch(LAMP),)
    left = ending()
    object.__setattr__(left, "survivors", ("sleep 1000",))
    assert_failed(judge_of(made, "end")(launched(pair("/state"), ending=left)), "process left behind", check=made)
    assert_passed(judge_of(made, "end")(launched(pair("/state"), ending=ending())))


def test_the_end_of_a_program_is_that_of_its_process() -> None:
    assert check("t1.3", Program("lamp.py"), EndsCleanly("end")).criteria[0].facts == (StartAndEnd(Program("lamp.py")),)


def test_a_launch_that_had_ended_is_explained_by_the_criterion_that_failed_by_it() -> None:
    made = check(
        "t1.3", LAMP, StartsPair("starts"), TOPIC, PairCommunicates("communicates"), EndsCleanly("end", bonus=True)
    )
    judge = judge_of(made, "end")
    assert_skipped(judge(launched(Graph(), exit=exited(1))), "`starts` shows why")
    assert_skipped(judge(launched(pair("/state", "/other"), exit=exited(1))), "`communicates` shows why")
    assert_skipped(judge(launched(pair("/state"), exit=exited(1))), "`communicates` shows why")


@pytest.mark.parametrize("form", [StartsPair("a"), PairCommunicates("a"), TOPIC, ArgumentMovesNamespace("a", "robot")])
def test_a_program_cannot_be_launched(form: Form) -> None:
    with pytest.raises(ValueError, match=r"lamp\.py is a Program: a criterion here needs a LaunchFile"):
        check("t1.3", Program("lamp.py"), form)


@pytest.mark.parametrize("form", [Publishes("a", STATE), Contains("a", STATE, "on")])
def test_a_launch_file_cannot_be_started_as_a_program(form: Form) -> None:
    with pytest.raises(ValueError, match=r"lamp_launch\.py is a LaunchFile: a criterion here needs a Program"):
        check("t1.3", LAMP, form)


def test_a_client_may_go_with_a_launch_file() -> None:
    made = check("t1.3", LAMP, StartsPair("starts"), CallsAll("client", Program("client.py"), ()))
    missing = judge_of(made, "client")(ClientRun(None))
    assert_failed(missing, "file missing", "client.py, next to lamp_launch.py", check=made)


def test_arguments_of_other_names() -> None:
    namespace = ArgumentMovesNamespace("namespace", "robot", and_topic=TOPIC, to=("house", "garden"))
    made = check("t1.3", LAMP, TOPIC, namespace)
    assert made.criteria[1].facts[1:4] == (
        LaunchWith(LAMP, topic="state_topic"),
        LaunchWith(LAMP, namespace="robot", to="house"),
        LaunchWith(LAMP, "state_topic", "robot", "house"),
    )
    judge = judge_of(made, "topic")
    assert_passed(judge(DEFAULT_RUN, moved(pair("/news"))))
    assert_failed(judge(DEFAULT_RUN, moved(pair("/news", "/state"))), "only one node is renamed", check=made)
    unused = judge(DEFAULT_RUN, moved(pair("/state")))
    assert "state_topic:=news is given" in explained(unused, made).cause
    judge = judge_of(made, "namespace")
    right = (
        in_house(pair("/house/state", namespace="/house")),
        in_house(pair("/house/news", namespace="/house"), state_topic="news"),
    )
    assert_passed(judge(DEFAULT_RUN, moved(pair("/news")), *right, None))
    twice = in_house(pair("/house/house/state", namespace="/house/house"))
    verdict = judge(DEFAULT_RUN, moved(pair("/news")), twice, right[1], None)
    assert_failed(verdict, "namespace applied twice", "/house/house", check=made)
    half = in_house(graph([endpoint("/house/state", "/house/talker")], [endpoint("/state", "/listener")]))
    verdict = judge(DEFAULT_RUN, moved(pair("/news")), half, right[1], None)
    assert_failed(verdict, "only one node is renamed", "/listener", check=made)


def test_a_namespace_without_a_topic() -> None:
    made = check("t1.3", LAMP, ArgumentMovesNamespace("namespace", "robot", to=("house", "garden")))
    judge = judge_of(made, "namespace")
    inside = in_house(pair("/house/state", namespace="/house"))
    assert_passed(judge(DEFAULT_RUN, inside, None))
    assert_failed(judge(DEFAULT_RUN, in_house(pair("/state")), None), "argument without effect", "robot", check=made)
    at_home = launched(pair("/house/state", namespace="/house"))
    assert_passed(judge(at_home, inside, in_house(pair("/garden/state", namespace="/garden"), "garden")))
    verdict = judge(at_home, inside, in_house(pair("/house/state", namespace="/house"), "garden"))
    assert_failed(verdict, "argument without effect", "garden", check=made)
