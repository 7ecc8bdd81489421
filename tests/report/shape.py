"""The shape of the reports, as programs that read them rely on it."""

from __future__ import annotations

import re
from typing import Any
from xml.etree.ElementTree import Element

TEXT_KEYS = ("id", "text", "expected", "observed", "cause", "step")


def assert_report_shape(document: Any) -> None:
    """Fail unless `document` has every key of the contract, no other, and the right types."""
    assert isinstance(document.get("message", ""), str)
    assert [key for key in document if key not in ("walls", "message")] == [
        "schema",
        "verdict",
        "duration_s",
        "environment",
        "exercises",
    ]
    for wall in document.get("walls", []):
        assert {name: type(value) for name, value in wall.items()} == {"name": str, "stands": bool, "detail": str}
    assert document["schema"] == "ros-tutor/report/1"
    assert document["verdict"] in ("passed", "failed", "error")
    assert_duration(document["duration_s"])
    assert list(document["environment"]) == ["ros_distro", "ros", "rmw", "ros_tutor"]
    assert all(isinstance(value, str) for value in document["environment"].values())
    for exercise in document["exercises"]:
        assert [key for key in exercise if key != "missing"] == [
            *("id", "title", "verdict", "duration_s", "submission", "criteria", "remarks")
        ]
        assert ("missing" in exercise) == (not exercise["submission"])
        if missing := exercise.get("missing"):
            assert {name: type(value) for name, value in missing.items()} == {
                "message": str,
                "looked_for": list,
                "found": list,
            }
        assert exercise["verdict"] in ("passed", "failed", "error")
        assert_duration(exercise["duration_s"])
        assert all(isinstance(name, str) for name in exercise["submission"])
        for criterion in exercise["criteria"]:
            assert_criterion_shape(criterion)


def assert_criterion_shape(criterion: Any) -> None:
    assert list(criterion) == [
        *("id", "text", "bonus", "status", "duration_s"),
        *("expected", "observed", "mistake", "cause", "step", "same_as", "evidence"),
    ]
    assert all(isinstance(criterion[key], str | None) for key in ("mistake", "same_as"))
    assert all(isinstance(criterion[key], str) for key in TEXT_KEYS)
    assert isinstance(criterion["bonus"], bool)
    assert criterion["status"] in ("passed", "failed", "skipped", "error")
    assert_duration(criterion["duration_s"])
    assert all(isinstance(line, str) for line in criterion["evidence"])


def assert_duration(value: Any) -> None:
    assert isinstance(value, float)
    assert value == round(value, 3)


JUNIT = {
    "testsuites": ({"name", "time", "tests", "failures", "errors"}, {"testsuite"}),
    "testsuite": ({"name", "time", "tests", "failures", "errors", "skipped"}, {"properties", "testcase", "system-out"}),
    "properties": (set(), {"property"}),
    "property": ({"name", "value"}, set()),
    "testcase": ({"name", "classname", "time"}, {"failure", "error", "skipped"}),
    "failure": ({"type", "message"}, set()),
    "error": ({"type", "message"}, set()),
    "skipped": ({"message"}, set()),
    "system-out": (set(), set()),
}
"""Element -> (attributes, children): the part of Jenkins's junit-10.xsd that GitLab and GitHub's reporters read."""


def assert_junit(root: Element) -> None:
    """Fail unless readers of JUnit files understand `root`, and its counts are right."""
    assert root.tag == "testsuites"
    for element in root.iter():
        attributes, children = JUNIT[element.tag]
        assert set(element.keys()) == attributes
        assert {child.tag for child in element} <= children
        if "time" in attributes:
            assert re.fullmatch(r"[0-9]{1,3}\.[0-9]{3}", element.get("time") or "")
    for suite in root:
        assert suite[0].tag == "properties"
        assert int(suite.get("tests") or "") == len(suite.findall("testcase"))
        for name, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
            assert int(suite.get(name) or "") == len(suite.findall(f"testcase/{tag}"))
        assert all(len(case) <= 1 for case in suite.findall("testcase"))
