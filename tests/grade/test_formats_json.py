"""`grade --format json`: every point, and why it was not given."""

from __future__ import annotations

import json
from typing import Any

from tests.grade import made
from tests.grade.schemas import GRADES, assert_valid
from tutor.grade.formats import render
from tutor.grade.gradebook import Gradebook


def document_of(gradebook: Gradebook) -> Any:
    document = json.loads(render(gradebook, "json"))
    assert_valid(document, GRADES)
    return document


def learner_in(document: Any, learner: str) -> Any:
    return next(entry for entry in document["learners"] if entry["id"] == learner)


def test_a_class() -> None:
    document = document_of(made.gradebook())
    assert [exercise["id"] for exercise in document["exercises"]] == ["i1.1", "i2.1"]
    assert {entry["id"] for entry in document["learners"]} == {learner.id for learner in made.LEARNERS}
    brian = learner_in(document, "brian")
    assert (brian["score"], brian["max_score"], brian["complete"]) == (11.67, 20.0, True)
    failed, passed = brian["exercises"]
    assert (failed["status"], failed["score"], failed["mistakes"]) == ("failed", 1.67, ["rate-used-as-a-period"])
    assert failed["criteria"][1]["cause"] == made.RATE.cause
    assert failed["criteria"][1]["step"] == made.STEP
    assert failed["criteria"][2]["same_as"] == failed["criteria"][1]["id"]
    assert (passed["status"], passed["score"]) == ("passed", 10.0)


def test_what_a_fault_left_unjudged_has_no_score() -> None:
    document = document_of(made.gradebook())
    missing, unjudged = learner_in(document, "chloe")["exercises"]
    assert (missing["status"], missing["score"]) == ("missing", 0.0)
    assert missing["message"] == "the exercise's file is not there"
    assert (unjudged["status"], unjudged["score"]) == ("error", None)
    (not_started,) = learner_in(document, "dev")["exercises"]
    assert (not_started["status"], not_started["score"], not_started["criteria"]) == ("error", None, [])
    assert not_started["message"] == "the check was silent for 120 s"
    assert not learner_in(document, "chloe")["complete"]


def test_steps_only_if_learners_may_know_them() -> None:
    text = render(made.gradebook(steps=False), "json")
    assert made.STEP not in text
    assert made.RATE.cause in text
    assert '"step"' not in text


def test_nothing_from_outside_controls_a_terminal() -> None:
    for value in _texts(document_of(made.gradebook())):
        assert all(character.isprintable() or character == "\n" for character in value)


def _texts(value: Any) -> list[str]:
    if isinstance(value, dict):
        return [text for each in value.values() for text in _texts(each)]
    if isinstance(value, list):
        return [text for each in value for text in _texts(each)]
    return [value] if isinstance(value, str) else []
