"""Each likely cause is recognised by what would be seen of it, and by nothing else."""

from __future__ import annotations

import pytest

from tests.checks.made import CRASH, CRASHED, FOLDER, NO_NODE, UP, exited, graph, lines, trace
from tests.judge.real import crash
from tutor.judge.causes import last_words, of_process, of_silence, same_name, wrong_topic
from tutor.judge.trace import Endpoint, Graph, Trace
from tutor.judge.tracebacks import Traceback, find

TOPIC, TYPE = "/sensor/temperature", "std_msgs/msg/Float64"
NOWHERE = Graph()


def parameter_type(wanted: str, given: str) -> str:
    return f"""Traceback (most recent call last):
  File "{FOLDER}/node.py", line 9, in __init__
    self.declare_parameter('publish_rate', 1)
rclpy.exceptions.InvalidParameterTypeException: Trying to set parameter 'publish_rate' to '2.0' of type '{given}', \
expecting type '{wanted}': wrong"""


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (trace(graph=NOWHERE, err=crash("x =")), "syntax error", "node.py, line 1: x ="),
        (trace(graph=NOWHERE, err=crash("def f():\npass")), "syntax error", "line 2"),
        (trace(graph=NOWHERE, err=crash("import std_msg")), "import error", "No module named 'std_msg'"),
        (trace(graph=NOWHERE, err=crash("from os import nothing")), "import error", "line 1"),
        (trace(err=parameter_type("INTEGER", "DOUBLE"), exit=exited(1)), "integer parameter", "line 9"),
        (trace(err=parameter_type("STRING", "DOUBLE"), exit=exited(1)), "wrong parameter type", "publish_rate"),
        (trace(err=crash("raise SystemError('x')"), exit=exited(1)), "float in an int field", "SystemError"),
        (
            trace(err=crash("assert False, \"The 'sum' field must be of type 'int'\""), exit=exited(1)),
            "float in an int field",
            "sum",
        ),
        (trace(err=crash("assert False, 'other'"), exit=exited(1)), "unhandled exception", "other"),
        (CRASHED, "unhandled exception", "node.py, line 12: self.nothing()"),
        (trace(err=CRASH), "unhandled exception", "AttributeError"),
        (trace(exit=exited(0, after_s=0.4)), "exit at once", "0.4 s"),
        (trace(exit=exited(0, after_s=9.0)), "exit at once", "9.0 s"),
        (trace(exit=exited(3)), "exit at once", "exit code 3"),
        (trace(exit=exited(signal=9)), "killed", "SIGKILL"),
        (trace(exit=exited(signal=77)), "killed", "signal 77"),
        (trace(exit=exited(0), uncalled_main=True), "no main call", "main()"),
        (NO_NODE, "no node", "made no ROS node"),
        (trace(graph=NOWHERE, dropped_lines=5), "no node", "prints without end"),
    ],
)
def test_why_the_process_did_not_do_its_work(seen: Trace, cause: str, word: str) -> None:
    found = of_process(seen)
    assert found is not None
    assert found.name == cause
    assert word in found.text
    assert found.hint


@pytest.mark.parametrize("seen", [trace(), trace(uncalled_main=True), trace(out=CRASH), trace(dropped_lines=5)])
def test_a_node_that_is_up_gives_no_cause(seen: Trace) -> None:
    assert of_process(seen) is None


@pytest.mark.parametrize(
    ("seen", "answers", "cause", "word"),
    [
        (CRASHED, True, "unhandled exception", ""),
        (NO_NODE, True, "no node", ""),
        (trace(graph=graph(publishers={TOPIC: TYPE})), False, "no spin", "/node"),
        (trace(graph=graph(publishers={TOPIC: TYPE})), True, "no messages", TOPIC),
        (trace(graph=graph(publishers={TOPIC: "std_msgs/msg/Float32"})), True, "wrong type", "std_msgs/msg/Float32"),
        (trace(graph=graph(publishers={"/sensor_temperature": TYPE})), True, "wrong topic", "slash"),
        (trace(graph=graph(publishers={"/sensortemperature": TYPE})), True, "wrong topic", "slash"),
        (trace(graph=graph(publishers={"/robot/sensor/temperature": TYPE})), True, "wrong topic", "namespace"),
        (trace(graph=graph(publishers={"/temperature": TYPE})), True, "wrong topic", "first part"),
        (trace(graph=graph(publishers={"/sensor/temprature": TYPE})), True, "wrong topic", "spelled differently"),
        (trace(graph=graph(publishers={"/anything": TYPE})), True, "wrong topic", "spelled differently"),
        (trace(graph=graph(publishers={"/sensor/temperatur": "std_msgs/msg/String"})), True, "wrong topic", ""),
        (trace(graph=graph(publishers={"/scan": "sensor_msgs/msg/LaserScan"})), True, "no publisher", "/node"),
        (trace(graph=UP), True, "no publisher", TOPIC),
        (trace(graph=UP), False, "no publisher", TOPIC),
    ],
)
def test_why_nothing_came(seen: Trace, answers: bool, cause: str, word: str) -> None:
    found = of_silence(seen, TOPIC, TYPE, answers=answers)
    assert found.name == cause
    assert word in found.text
    assert found.hint


def test_the_nearest_of_several_wrong_topics_is_explained() -> None:
    endpoints = [
        Endpoint(name, TYPE, "/node", "reliable", "volatile") for name in ("/zzz", "/me/sensor/temperature", "/a")
    ]
    assert "namespace" in wrong_topic(endpoints, TOPIC).text


def test_last_words_are_the_last_lines_with_something_in_them() -> None:
    text = "\n".join(f"line {i}\n   " for i in range(20))
    assert last_words(trace(out=text)) == tuple(f"line {i}" for i in range(14, 20))
    assert last_words(trace(out=text), 2) == ("line 18", "line 19")
    assert last_words(trace()) == ()


def test_the_words_of_a_traceback() -> None:
    (found,) = find(lines(CRASH))
    assert found.raised == "AttributeError: 'Sensor' object has no attribute 'nothing'"
    assert Traceback("KeyboardInterrupt", "", ()).raised == "KeyboardInterrupt"


def test_two_nodes_of_one_name_are_told_and_two_of_different_names_are_not() -> None:
    cause = same_name(Trace("x.py", graph=Graph(nodes=("/a", "/talker", "/talker"))))
    assert cause is not None
    assert cause.name == "second node of the same name"
    assert "2 nodes called /talker" in cause.text
    assert same_name(Trace("x.py", graph=Graph(nodes=("/a", "/talker")))) is None
