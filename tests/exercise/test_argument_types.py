"""What an author writes in place of what a form takes is refused at once: not all of them run a type checker."""

# mypy: disable-error-code="arg-type, dict-item"

from __future__ import annotations

import re

import pytest

from tutor.exercise import (
    Answers,
    AtLeast,
    Defaults,
    InRange,
    Parameter,
    Program,
    Publishes,
    RateAtRunTime,
    SetAtStart,
    SetsRate,
    Topic,
    check,
)
from tutor.exercise.form import Form

STATE = Topic("/state", "std_msgs/msg/String")
RATE = Parameter("rate", 2.0, SetsRate(STATE))


@pytest.mark.parametrize(
    ("criterion", "message"),
    [
        (Defaults("defaults", RATE), "defaults: parameters takes several values, so put one into parentheses: (…,)"),
        (Publishes("state", "/state"), "state: topic takes a Topic, not '/state'"),
        (AtLeast("often", STATE, "3"), "often: messages takes a whole number, not '3'"),
        (AtLeast("often", STATE, True), "often: messages takes a whole number, not True"),
        (
            InRange("range", Topic("/a", "std_msgs/msg/Float64", low="x", high=3)),
            "range: Topic: low takes a number or None",
        ),
        (RateAtRunTime("rate", RATE, (3.0,)), "rate: steps_hz takes 2 values, each a number, not (3.0,)"),
        (Publishes("state", STATE, after="other"), "state: after takes a Form or several values, each a Form"),
        (SetAtStart("start", ({"rate": 2.0},)), "start: starts takes several values, each a dict"),
        (Answers("sums", (), questions=3), "sums: questions takes a function, not 3"),
    ],
)
def test_an_argument_of_another_type_is_refused(criterion: Form, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        check("x1.1", Program("a.py"), criterion)


@pytest.mark.parametrize(
    ("started", "message"),
    [
        ("a.py", "x1.1: what is started is a Program or a LaunchFile, not 'a.py'"),
        (Program(3), "Program: file takes a text"),
    ],
)
def test_what_is_started_is_a_program_or_a_launch_file(started: Program, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        check("x1.1", started, Publishes("state", STATE))
