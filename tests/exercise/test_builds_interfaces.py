"""The form about a package of message types, on made builds."""

from __future__ import annotations

import pytest

from tutor.exercise import BuildsInterfaces
from tutor.judge.interface_build import InterfaceBuild
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.verdict import Failure, Status

DING = ("float64 volume", "string name")
FORM = BuildsInterfaces("types", "bell_interfaces", {"msg/Ding": DING})


def _failure(*builds: InterfaceBuild) -> tuple[str, Observation]:
    verdict = FORM.judge(builds)
    assert isinstance(verdict, Failure)
    assert verdict.seen is not None
    return verdict.observed, verdict.seen


def test_a_package_with_the_agreed_fields_passes_whatever_else_is_in_it() -> None:
    build = InterfaceBuild("bell_interfaces", {"msg/Ding": DING, "msg/Dong": ()}, unlisted=("msg/Old.msg",))
    assert FORM.judge([InterfaceBuild("other"), build]).status is Status.PASSED


@pytest.mark.parametrize(
    ("found", "says"),
    [
        (("float64 volume",), "msg/Ding has no field name"),
        (("float64 volumes", "string name"), "msg/Ding has no field volume, only volumes"),
        (("float32 volume", "string name"), "msg/Ding: volume is float32, and was agreed to be float64"),
        ((*DING, "bool loud"), "msg/Ding has a field more than was agreed on: loud"),
        (("string name", "float64 volume"), "in another order"),
    ],
)
def test_the_first_difference_is_told(found: tuple[str, ...], says: str) -> None:
    observed, seen = _failure(InterfaceBuild("bell_interfaces", {"msg/Ding": found}))
    assert says in observed
    assert seen.symptom is Symptom.OTHER_TYPES


def test_what_is_not_built_is_told_with_its_reason() -> None:
    observed, seen = _failure(
        InterfaceBuild("bell_interfaces", problems=("msg/Ding.msg:3: no", "msg/Ding.msg:4: neither"))
    )
    assert observed == "msg/Ding.msg:3: no"
    assert seen.symptom is Symptom.NOT_BUILT
    assert seen.about["reason"] == "msg/Ding.msg:3: no"


def test_a_file_that_is_not_listed_is_told() -> None:
    _, seen = _failure(InterfaceBuild("bell_interfaces", unlisted=("msg/Ding.msg",)))
    assert seen.about["unlisted"] == "msg/Ding.msg"


def test_a_package_of_another_name_is_named() -> None:
    assert "only bells" in _failure(InterfaceBuild("bells"))[0]
    assert "no interface package" in _failure()[0]
