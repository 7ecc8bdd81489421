"""The report on a fault: what is right, what is wrong, and what a wrong one is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from tutor.exercise import Faults, NamesFault
from tutor.judge.verdict import Failure, Verdict

CASES = """
report: tank_report.yaml
kinds:
  qos: {says: the QoS does not match, shows: Both ends are listed.}
  rate: {says: it comes at a wrong rate, shows: "`ros2 topic hz` says so."}
  value: {says: a parameter has a wrong value, shows: "`ros2 param get` says so."}
cases:
  - {id: a1b2, what: qos, where: pump.py, change: [{from: a, to: b}]}
  - {id: c3d4, what: [value, rate], where: tank.yaml, change: [{from: a, to: b}]}
"""


@pytest.fixture
def form(tmp_path: Path) -> NamesFault:
    file = tmp_path / "cases.yaml"
    file.write_text(CASES)
    return NamesFault("found", Faults.read(file))


def seen(verdict: Verdict) -> tuple[str, str, bool]:
    assert isinstance(verdict, Failure)
    assert verdict.seen is not None
    return verdict.seen.says, verdict.seen.do, verdict.seen.about["reported"]


@pytest.mark.parametrize(
    "report",
    [
        "case: a1b2\nwhat: qos\nwhere: pump.py\ntries: 1\n",
        "{case: a1b2, what: qos, where: pump.py}",
        "# mine\ncase: c3d4\nwhat: value\nwhere: tank.yaml\n",
        "case: a1b2\nwhat: QoS\nwhere: my_package/pump.py\n",
        "case: c3d4\nwhat: rate  # it is a parameter\nwhere: 'tank.yaml'\ntries: many\n",
    ],
)
def test_the_right_report(form: NamesFault, report: str) -> None:
    assert form.judge(report).passed


def test_an_answer_after_several_says_so(form: NamesFault) -> None:
    verdict = form.judge("case: a1b2\nwhat: qos\nwhere: pump.py\ntries: 3\n")
    assert verdict.observed == "the QoS does not match, in pump.py, answer 3"


@pytest.mark.parametrize(
    ("report", "says"),
    [
        ("", "does not say which case"),
        ("what: qos\nwhere: pump.py\n", "does not say which case"),
        ("case: zzzz\nwhat: qos\nwhere: pump.py\n", "does not say which case"),
        ("case: a1b2\nwhat:\nwhere:\n", "nothing is reported"),
        ("case: a1b2\nwhat: qos\n", "`where` is not reported"),
        ("case: a1b2\nwhat:\nwhere: pump.py\n", "`what` is not reported"),
        ("case: a1b2\nwhat: it is: the QoS\nwhere: pump.py\n", "not YAML"),
        ("just a word", "not YAML"),
        ("case: a1b2\nwhat: reliability\nwhere: pump.py\n", "none of the choices for `what`"),
        ("case: a1b2\nwhat: qos\nwhere: pump\n", "none of the choices for `where`"),
        ("case: a1b2\nwhat: [qos]\nwhere: pump.py\n", "none of the choices for `what`"),
        ("case: a1b2\nwhat: &a [*a, *a]\nwhere: pump.py\n", "none of the choices for `what`"),
        ("[" * 50_000, "not YAML"),
        ("when: 2020-13-50", "not YAML"),
    ],
)
def test_no_report_yet(form: NamesFault, report: str, says: str) -> None:
    words, do, reported = seen(form.judge(report))
    assert says in words
    assert do
    assert not reported


@pytest.mark.parametrize(
    ("what", "where", "says"),
    [
        ("rate", "pump.py", "the file is right"),
        ("rate", "tank.yaml", "not the fault of the system"),
    ],
)
def test_a_wrong_report_is_told_what_it_would_show(form: NamesFault, what: str, where: str, says: str) -> None:
    words, do, reported = seen(form.judge(f"case: a1b2\nwhat: {what}\nwhere: {where}\n"))
    assert says in words
    assert do.startswith("If it were so: ")
    assert reported


def test_the_right_kind_in_another_file_is_not_called_another_fault(form: NamesFault) -> None:
    """What it would show is what the learner has seen, so it would lead away from it."""
    words, do, reported = seen(form.judge("case: a1b2\nwhat: qos\nwhere: tank.yaml\n"))
    assert "this kind of fault is right" in words
    assert "hand-over note" in do
    assert reported


def test_a_file_that_is_no_case_file(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="cannot be read"):
        Faults.read(tmp_path / "none.yaml")
