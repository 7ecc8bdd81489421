"""Combining statuses into one, the structure of a check, and small helpers."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.checks.builders import trace
from tests.failures import failure
from tutor.judge.check import Check, Criterion
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Report, overall, tell_roots_once
from tutor.judge.trace import Exit
from tutor.judge.verdict import Status, Verdict, fault, passed, skipped
from tutor.judge.wording import describe_no_answer, shape

P, F, S, E = Status.PASSED, Status.FAILED, Status.SKIPPED, Status.ERROR


@pytest.mark.parametrize(
    ("statuses", "folded"),
    [
        ((), E),
        ((P,), P),
        ((F,), F),
        ((S,), F),
        ((E,), E),
        ((P, S), F),
        ((P, E), E),
        ((P, F), F),
        ((S, E), E),
        ((S, F), F),
        ((E, F), F),
        ((P, S, E), E),
        ((P, S, F), F),
        ((P, E, F), F),
        ((S, E, F), F),
        ((P, S, E, F), F),
    ],
)
def test_overall(statuses: tuple[Status, ...], folded: Status) -> None:
    assert overall(statuses) is folded
    assert overall(reversed(statuses * 2)) is folded


def criterion(status: Status, bonus: bool = False) -> CriterionResult:
    return CriterionResult("x", "X", bonus, Verdict(status), 0.1)


def exercise(*criteria: CriterionResult) -> ExerciseResult:
    return ExerciseResult("i1.1", "T", ("a.py",), criteria, 1.0)


@pytest.mark.parametrize(("required", "bonus"), list(product(Status, Status)))
def test_a_bonus_never_changes_a_verdict(required: Status, bonus: Status) -> None:
    assert exercise(criterion(required), criterion(bonus, True)).verdict is overall([required])


def test_a_failed_bonus_alone_does_not_fail_the_exercise() -> None:
    assert exercise(criterion(F, True)).verdict is P
    assert exercise().verdict is E


@given(st.lists(st.sampled_from(Status), min_size=1))
def test_the_verdict_of_a_report_follows_from_its_exercises(statuses: list[Status]) -> None:
    exercises = tuple(exercise(criterion(status)) for status in statuses)
    report = Report(Environment("jazzy", "bundled", "rmw", "0"), exercises, 1.0)
    assert report.verdict is overall(overall([status]) for status in statuses)
    assert (report.verdict is P) == all(status is P for status in statuses)


def test_constructors_of_each_kind_of_verdict() -> None:
    assert passed("e", "o", ["1"]) == Verdict(P, "e", "o", evidence=("1",))
    assert failure("e", "o", ("n", "t", "h"), iter("12")) == Verdict(F, "e", "o", "n: t", "h", ("1", "2"), "n")
    assert skipped("because") == Verdict(S, cause="because")
    assert fault("what", "do this", ["1"]) == Verdict(E, cause="what", step="do this", evidence=("1",))
    assert [Verdict(status).passed for status in Status] == [True, False, False, False]


def check_of(*criteria: tuple[str, tuple[str, ...]]) -> Check:
    return Check("i9.9", tuple(Criterion(name, lambda: passed("", ""), (), after=after) for name, after in criteria))


def test_a_criterion_may_depend_on_earlier_ones() -> None:
    assert [c.id for c in check_of(("a", ()), ("b", ("a",)), ("c", ("a", "b"))).criteria] == ["a", "b", "c"]


@pytest.mark.parametrize(
    "wrong",
    [
        [("a", ()), ("a", ())],
        [("a", ("a",))],
        [("a", ("b",)), ("b", ())],
        [("a", ("nothing",))],
        [("a", ()), ("b", ("a", "c")), ("c", ())],
    ],
)
def test_a_check_with_invalid_dependencies_is_rejected(wrong: list[tuple[str, tuple[str, ...]]]) -> None:
    with pytest.raises(ValueError, match=r"i9\.9"):
        check_of(*wrong)


@given(st.integers(), st.floats(-1e6, 1e6).map(lambda value: f"{value:.3f}"))
def test_a_shape_is_a_message_without_its_numbers(whole: int, decimal: str) -> None:
    assert shape(f"a={whole} b={decimal}.") == "a=# b=#."
    assert shape("no number") == "no number"


def _failure(criterion: str, cause: str, *, place: str = "", root: str = "", bonus: bool = False) -> CriterionResult:
    verdict = Verdict(Status.FAILED, cause=cause, step="Do.", mistake=cause.partition(":")[0], place=place, root=root)
    return CriterionResult(criterion, criterion, bonus, verdict, 0.0)


@pytest.mark.parametrize(
    ("first", "second", "same"),
    [
        (_failure("a", "late: after 0.4 s"), _failure("b", "late: after 0.6 s"), True),
        (_failure("a", "late: door"), _failure("b", "late: bell"), False),
        (_failure("a", "late: door", place="x.py:1"), _failure("b", "late: bell", place="x.py:1"), True),
        (_failure("a", "late: door", place="x.py:1"), _failure("b", "late: door", place="x.py:2"), False),
        (_failure("a", "late: x", place="x.py:1", root="r"), _failure("b", "late: y", place="x.py:2", root="r"), True),
        (_failure("a", "late: door"), _failure("b", "early: door"), False),
    ],
)
def test_a_root_is_told_once(first: CriterionResult, second: CriterionResult, same: bool) -> None:
    told = tell_roots_once((first, second))
    assert told[0] == first
    assert (told[1].verdict.same_as, told[1].verdict.step) == (("a", "") if same else ("", "Do."))


def test_a_required_criterion_tells_the_root() -> None:
    told = tell_roots_once((_failure("a", "late: x", bonus=True), _failure("b", "late: x")))
    assert [each.verdict.same_as for each in told] == ["b", ""]


@pytest.mark.parametrize(
    ("exit", "waited_s", "said"),
    [
        (None, 4.99, "no answer in 5 s"),
        (None, 2.12, "no answer in 2.1 s, and none to come: all of its threads are blocked"),
        (Exit(1, None, 0.8), 0.3, "no answer: the process ended by itself, 0.8 s after its start, with exit code 1"),
    ],
)
def test_why_there_was_no_longer_wait_for_an_answer_is_said(exit: Exit | None, waited_s: float, said: str) -> None:
    assert describe_no_answer(trace(exit=exit), waited_s, 5.0) == said
