"""`grade --format junit`: a suite for each learner, a case for each criterion."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from tests.grade import made
from tests.report.shape import assert_junit
from tutor.grade.formats import render


@pytest.fixture
def root() -> ElementTree.Element:
    root = ElementTree.fromstring(render(made.gradebook(), "junit"))
    assert_junit(root)
    return root


def suite_of(root: ElementTree.Element, learner: str) -> ElementTree.Element:
    return next(suite for suite in root if suite.find(f"properties/*[@value='{learner}']") is not None)


def outcomes(suite: ElementTree.Element, exercise: str) -> dict[str, str]:
    cases = suite.findall("testcase")
    return {
        case.get("name") or "": case[0].tag if len(case) else "passed"
        for case in cases
        if (case.get("classname") or "").endswith(exercise)
    }


def test_a_case_for_each_criterion(root: ElementTree.Element) -> None:
    assert len(root) == len(made.LEARNERS)
    criteria = [criterion.id for criterion in made.lesson("i1.1").criteria]
    assert outcomes(suite_of(root, "brian"), "i1.1") == {
        criteria[0]: "passed",
        criteria[1]: "failure",
        criteria[2]: "failure",
        **dict.fromkeys(criteria[3:], "skipped"),
    }
    assert set(outcomes(suite_of(root, "brian"), "i2.1").values()) == {"passed", "skipped"}, "a bonus fails nothing"


def test_missing_fails_and_a_fault_is_an_error(root: ElementTree.Element) -> None:
    chloe = suite_of(root, "chloe")
    required = [criterion.id for criterion in made.lesson("i1.1").criteria if not criterion.bonus]
    assert [outcomes(chloe, "i1.1")[name] for name in required] == ["failure"] * len(required)
    assert list(outcomes(chloe, "i2.1").values()).count("error") == 1
    assert outcomes(suite_of(root, "dev"), "i1.1") == {"check": "error"}


def test_no_two_cases_have_the_same_name(root: ElementTree.Element) -> None:
    names = [(case.get("classname"), case.get("name")) for case in root.iter("testcase")]
    assert len(names) == len(set(names))


def test_remarks_say_of_which_exercise_and_come_last(root: ElementTree.Element) -> None:
    ada = suite_of(root, "ada")
    assert ada[-1].tag == "system-out"
    assert [line for line in (ada[-1].text or "").splitlines() if "but …" in line] == [
        "i1.1: This works, but …",
        "i2.1: This works, but …",
    ]


def test_no_learner_is_in_the_suite_of_another(root: ElementTree.Element) -> None:
    for suite in root:
        text = "\n".join([*suite.itertext(), *(value for element in suite.iter() for value in element.attrib.values())])
        others = [learner for learner in made.LEARNERS if f"{learner.email}" not in text]
        assert len(others) == len(made.LEARNERS) - 1
        assert not [learner.name for learner in others if learner.name in text]


def test_steps_only_if_learners_may_know_them() -> None:
    assert made.STEP in render(made.gradebook(), "junit")
    silent = render(made.gradebook(steps=False), "junit")
    assert made.STEP not in silent
    assert "explain rate-used-as-a-period" not in silent
    assert made.RATE.cause in silent
