"""What the last whole check of each exercise found, on disk."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tutor.judge.result import CriterionResult, ExerciseResult, Remark
from tutor.judge.verdict import Status, Verdict, fault, passed
from tutor.workspace import LastCheck, Workspace, record

CRITERIA = {"i1.1": ("publishes", "rate")}
BAD = Verdict(
    Status.FAILED,
    "5 Hz",
    "0.2 Hz",
    "rate used as a period: é",
    "Divide.",
    ("line 3: é",),
    "rate-used-as-a-period",
    "a:3",
)
RESULT = ExerciseResult(
    "i1.1",
    "Sensor Publisher",
    ("a.py",),
    (
        CriterionResult("publishes", "It publishes", False, passed("values", "3 values"), 1.0),
        CriterionResult("rate", "It has a rate", False, BAD, 2.5),
    ),
    2.5,
    digests={"a.py": "12ab"},
    remarks=(Remark("shutdown-after-ctrl-c", "line 9", "a.py", 9),),
)


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    return Workspace(tmp_path)


def read(workspace: Workspace, said: list[str] | None = None) -> LastCheck | None:
    return workspace.last_checks((said if said is not None else []).append).read(["i1.1", "i1.2"]).get("i1.1")


def test_a_check_is_kept_whole_with_the_time_of_its_attempt(workspace: Workspace) -> None:
    progress = record([RESULT], workspace, CRITERIA)
    last = progress.of("i1.1").last
    assert last is not None
    assert read(workspace) == LastCheck(last.at, RESULT)
    assert not list(workspace.last_checks().folder.glob(".*")), "no temporary file is left"


def test_a_check_of_some_criteria_hides_nothing_and_an_error_is_kept_too(workspace: Workspace) -> None:
    record([RESULT], workspace, CRITERIA)
    kept = read(workspace)
    progress = record([replace(RESULT, criteria=RESULT.criteria[:1])], workspace, CRITERIA)
    assert read(workspace) == kept
    assert kept is not None
    assert kept.is_current(progress)

    broken = replace(RESULT, criteria=tuple(replace(c, verdict=fault("no room", "make room")) for c in RESULT.criteria))
    record([broken], workspace, CRITERIA)
    found = read(workspace)
    assert found is not None
    assert found.result.verdict is Status.ERROR


def test_findings_that_a_later_check_made_untrue_are_not_current(workspace: Workspace) -> None:
    record([RESULT], workspace, CRITERIA)
    kept = read(workspace)
    assert kept is not None
    later = workspace.progress().read().with_attempt(RESULT, whole=True)
    assert replace(kept, at="2001-01-01T00:00:00Z").is_current(later) is False


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "it is damaged"),
        ('{"schema": "ros-tutor/last-check/2", "at": 3}', "it is damaged"),
        ('{"schema": "ros-tutor/last-check/0"}', "it is damaged"),
        ('{"schema": "ros-tutor/last-check/3"}', "a newer ros-tutor wrote it"),
    ],
)
def test_a_damaged_file_is_set_aside(workspace: Workspace, text: str, reason: str) -> None:
    record([RESULT], workspace, CRITERIA)
    path = workspace.last_checks().path_of("i1.1")
    path.write_text(text)
    said: list[str] = []
    assert read(workspace, said) is None
    (aside,) = path.parent.glob("*.damaged-*")
    assert aside.read_text() == text
    assert said == [f"the last check of i1.1 could not be read ({reason}); the file is kept as {aside}"]


FORMER = """{
 "schema": "ros-tutor/last-check/1",
 "at": "2026-01-02T03:04:05Z",
 "result": {"id": "i1.1", "title": "Sensor Publisher", "submission": ["a.py"], "duration_s": 2.5, "criteria": [
  {"id": "rate", "text": "It has a rate", "bonus": false, "duration_s": 2.5, "verdict": {
   "status": "failed", "expected": "5 Hz", "observed": "0.2 Hz", "cause": "rate used as a period: it is",
   "hint": "line 3 becomes:\\n    1 / rate", "evidence": ["line 3"], "spins": true}}],
  "unjudged": [], "digests": {"a.py": "12ab"}, "given": [], "lookup": null, "not_shown": []}
}"""


def test_a_file_of_the_former_schema_is_read_without_its_steps(workspace: Workspace) -> None:
    path = workspace.last_checks().path_of("i1.1")
    path.parent.mkdir(parents=True)
    path.write_text(FORMER)
    said: list[str] = []
    found = read(workspace, said)
    assert said == []
    assert found is not None
    (rate,) = found.result.criteria
    assert rate.verdict == Verdict(
        Status.FAILED, "5 Hz", "0.2 Hz", "rate used as a period: it is", evidence=("line 3",), spins=True
    )
    assert [each.name for each in path.parent.iterdir()] == ["i1.1.json"]


def test_a_check_of_another_exercise_is_not_shown(workspace: Workspace) -> None:
    record([RESULT], workspace, CRITERIA)
    said: list[str] = []
    last_checks = workspace.last_checks(said.append)
    last_checks.path_of("i1.1").rename(last_checks.path_of("i1.2"))
    assert last_checks.read(["i1.1", "i1.2"]) == {}
    assert "it is of another exercise" in said[0]
