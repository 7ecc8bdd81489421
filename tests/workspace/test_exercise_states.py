"""The state of an exercise: one answer for the app, the command line and the checklist."""

from __future__ import annotations

from tutor.content import load_course
from tutor.judge.verdict import Status
from tutor.report.assessment import assess
from tutor.tui import wording
from tutor.workspace import Attempt, ExerciseProgress, Progress, State, exercise_state

LESSON = load_course().find("i1.1")
REQUIRED = tuple(criterion.id for criterion in LESSON.criteria if not criterion.bonus)


def attempt(*passed: str, judged: tuple[str, ...] = ()) -> Attempt:
    verdict = Status.PASSED if set(judged or REQUIRED) <= set(passed) else Status.FAILED
    return Attempt("2026-01-01T00:00:00Z", verdict, passed, whole=not judged, judged=judged)


def progress(*attempts: Attempt) -> ExerciseProgress:
    whole = [each.verdict for each in attempts if each.whole]
    best = Status.PASSED if Status.PASSED in whole else whole[-1] if whole else None
    return ExerciseProgress("2026-01-01T00:00:00Z", attempts, best)


def test_a_criterion_checked_on_its_own_counts_everywhere() -> None:
    one = progress(attempt("range", judged=("range",)))
    found = exercise_state(LESSON, one)
    assert (found.state, found.met, found.missed) == (State.NOT_PASSED, ("range",), ())
    (row,) = (each for each in assess(load_course(), Progress({"i1.1": one}), {}).exercises if each.id == "i1.1")
    assert (row.met, row.required) == (1, 6)
    assert wording.progress_label(found) == ("◐", "1 of 6 met")


def test_the_latest_check_of_each_criterion_counts() -> None:
    found = exercise_state(LESSON, progress(attempt("publishes", "range"), attempt("rate", judged=("rate", "range"))))
    assert found.met == ("publishes", "rate")
    assert found.missed == tuple(id for id in REQUIRED if id not in ("publishes", "rate"))


def test_a_passed_exercise_stays_passed() -> None:
    found = exercise_state(LESSON, progress(attempt(*REQUIRED, "shutdown"), attempt()))
    assert (found.state, found.met, found.missed, found.bonus_met) == (State.PASSED, REQUIRED, (), ())


def test_state_before_the_first_check() -> None:
    assert exercise_state(LESSON, ExerciseProgress("2026-01-01T00:00:00Z")).state is State.STARTED
    assert exercise_state(LESSON, ExerciseProgress(), has_files=True).state is State.STARTED
    assert exercise_state(LESSON, ExerciseProgress()).state is State.NOT_STARTED
