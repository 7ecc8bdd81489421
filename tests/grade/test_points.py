"""Points: equal parts or a teacher's own, for what passed; unknown where a fault left something unjudged."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.grade.made import ADA, FAULT, RATE, course, gradebook, lesson, missing, not_started, passing
from tutor.errors import UsageError
from tutor.grade.points import Points
from tutor.grade.results import Result
from tutor.judge.verdict import Status, Verdict, passed, skipped

I11 = lesson("i1.1")
REQUIRED = [criterion.id for criterion in I11.criteria if not criterion.bonus]
BONUS = [criterion.id for criterion in I11.criteria if criterion.bonus]


def with_verdicts(verdicts: Mapping[str, Verdict]) -> Result:
    """A result of i1.1 in which these criteria ended so, and the other required ones passed."""
    result = passing(ADA)
    judged = result.report.exercises[0]
    others = {True: RATE, False: passed("", "")}
    criteria = tuple(replace(each, verdict=verdicts.get(each.id, others[each.bonus])) for each in judged.criteria)
    return replace(result, report=replace(result.report, exercises=(replace(judged, criteria=criteria),)))


def read(folder: Path, text: str) -> Points:
    file = folder / "points.toml"
    file.write_text(text)
    return Points.read(file, course())


def test_equal_parts_by_default() -> None:
    assert len(REQUIRED) >= 3
    assert BONUS
    share = 10 / len(REQUIRED)
    score = Points().score(with_verdicts({REQUIRED[0]: RATE, REQUIRED[1]: skipped("x"), BONUS[0]: passed("", "")}))
    assert score.score == pytest.approx(10 - 2 * share)
    assert score.max_score == 10
    assert [(each.id, each.bonus) for each in score.criteria] == [(each.id, each.bonus) for each in I11.criteria]
    by_id = {each.id: each for each in score.criteria}
    assert by_id[REQUIRED[0]].score == 0
    assert by_id[REQUIRED[0]].max_score == pytest.approx(share)
    assert (by_id[BONUS[0]].score, by_id[BONUS[0]].max_score) == (0, 0)


def test_nothing_handed_in_is_a_zero_and_a_fault_is_none() -> None:
    assert Points().score(missing(ADA)).score == 0
    assert Points().score(not_started(ADA)) == Points().score(replace(not_started(ADA), cpu_s=0.0))
    for result in (
        not_started(ADA),
        with_verdicts({REQUIRED[0]: FAULT}),
        with_verdicts({REQUIRED[0]: FAULT, REQUIRED[1]: RATE}),
    ):
        score = Points().score(result)
        assert (score.score, score.max_score) == (None, 10)
    total = gradebook([with_verdicts({REQUIRED[0]: FAULT}), passing(ADA, "i2.1")]).total(ADA)
    assert (total.score, total.max_score, total.complete) == (10, 20, False)


def test_an_unjudged_bonus_counts_only_if_it_is_worth_something(tmp_path: Path) -> None:
    result = with_verdicts({BONUS[0]: FAULT})
    assert (result.status, result.unjudged) == ("passed", True)
    assert Points().score(result).score == 10
    worth = read(tmp_path, "[i1.1]\nbonus = 2\n")
    assert worth.score(result).score is None
    assert gradebook([result]).errors == []
    assert gradebook([result], points=worth).errors == [result]


FULL = with_verdicts({bonus: passed("", "") for bonus in BONUS})


@pytest.mark.parametrize(
    ("text", "score", "max_score"),
    [
        ("", 10, 10),
        ("default = 3", 3, 3),
        ("default = 3.5\n[i1.2]\npoints = 9", 3.5, 3.5),
        ("[i1.1]\npoints = 20", 20, 20),
        ('["i1.1"]\npoints = 20', 20, 20),
        ('["I1_1"]\npoints = 20', 20, 20),
        ("\ufeffdefault = 3", 3, 3),
        ("i1.1.points = 7", 7, 7),
        ("default = 4\n[i1.1]\nbonus = 1", 4 + len(BONUS), 4),
        ("[i1.1]", 10, 10),
        ("[i1.1]\npoints = 0", 0, 0),
        (f"[i1.1.criteria]\n{BONUS[0]} = 2.5", 12.5, 10),
        (f"[i1.1]\nbonus = 1\n[i1.1.criteria]\n{BONUS[0]} = 2.5", 12.5 + len(BONUS) - 1, 10),
        (f'["i1.1".criteria]\n{REQUIRED[0]} = 1', 10, 10),
    ],
)
def test_rules(tmp_path: Path, text: str, score: float, max_score: float) -> None:
    found = read(tmp_path, text).score(FULL)
    assert (found.score, found.max_score) == (score, max_score)


def test_weights_split_the_points(tmp_path: Path) -> None:
    points = read(tmp_path, f"[i1.1]\npoints = 20\n[i1.1.criteria]\n{REQUIRED[0]} = 2\n{REQUIRED[1]} = 3\n")
    by_id = {each.id: each.max_score for each in points.score(FULL).criteria}
    assert [by_id[name] for name in REQUIRED[:3]] == [8, 12, 0]
    assert points.score(with_verdicts({REQUIRED[0]: RATE})).score == 12
    assert points.score(with_verdicts({REQUIRED[2]: RATE})).score == 20
    assert points.score(with_verdicts({REQUIRED[2]: FAULT})).score is None


@settings(max_examples=40)
@given(st.floats(0, 1000), st.lists(st.floats(0.01, 100), min_size=len(REQUIRED), max_size=len(REQUIRED)))
def test_who_passes_everything_has_exactly_the_points(points: float, weights: list[float]) -> None:
    from tutor.grade.points import _Rule

    points = round(points, 2)
    rules = Points(10, {"i1.1": _Rule(points, 0, dict(zip(REQUIRED, weights, strict=True)))})
    assert rules.score(FULL).score == points
    failed = rules.score(with_verdicts(dict.fromkeys(REQUIRED, RATE)))
    assert (failed.score, failed.max_score) == (0, points)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("default = ", "Invalid value"),
        ("default = -1", "default: expected a number of points, not -1"),
        ("default = nan", "default: expected a number of points, not nan"),
        ("default = inf", "default: expected a number of points, not inf"),
        ("default = true", "default: expected a number of points, not True"),
        ('[i1.1]\npoints = "ten"', "i1.1: points: expected a number of points, not 'ten'"),
        ("[i1.1]\nbonus = -2", "i1.1: bonus: expected a number"),
        ("[i1.1]\npoint = 3", "i1.1: point is unknown; there are points, bonus and criteria"),
        ("[i9.9]\npoints = 3", "there is no exercise i9.9"),
        ("[i1]\npoints = 3", "there is no exercise i1"),
        ("[i1]\nbonus = 3\n[i1.1]\npoints = 2", "there is no exercise i1"),
        ('"i1.1" = 3', "i1.1: expected a table with points, bonus or criteria"),
        ("[i1.1]\ncriteria = 3", "i1.1: criteria: expected a table"),
        ("[i1.1.criteria]\nspeed = 3", f"i1.1: there is no criterion speed; there are {REQUIRED[0]}"),
        (f"[i1.1.criteria]\n{REQUIRED[0]} = []", f"i1.1: {REQUIRED[0]}: expected a number"),
        (f"[i1.1.criteria]\n{REQUIRED[0]} = 0", "i1.1: no required criterion has a weight above 0"),
    ],
)
def test_errors_are_named(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(UsageError, match=f"points.toml: .*{re.escape(message)}"):
        read(tmp_path, text)


def test_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be read: No such file"):
        Points.read(tmp_path / "none.toml", course())
    (tmp_path / "latin.toml").write_bytes(b"# \xfc")
    with pytest.raises(UsageError, match="it is not UTF-8"):
        Points.read(tmp_path / "latin.toml", course())


def test_status_and_verdict_agree() -> None:
    assert with_verdicts({}).status == "passed"
    assert with_verdicts({REQUIRED[0]: RATE}).status == "failed"
    assert with_verdicts({REQUIRED[0]: Verdict(Status.ERROR)}).status == "error"
