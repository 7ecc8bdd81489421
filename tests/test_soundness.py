"""Submissions under tests/submissions are judged as their expect.yaml says.

All the right ones and every second wrong one, so that the tests end in minutes; `python -m tests.soundness` judges all.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from concurrent.futures import Future

import pytest

from tests.soundness import Case, Outcome, cases, compare, judge
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status, Verdict

JOBS = 6
ALL = [case for case in cases() if case.kind == "right"] + [case for case in cases() if case.kind == "wrong"][::2]


@pytest.fixture(scope="module")
def outcomes() -> Iterator[dict[str, Future[Outcome]]]:
    """The outcome of each case, as it comes: several are judged at a time, since a check mostly waits."""
    futures: dict[str, Future[Outcome]] = {str(case): Future() for case in ALL}

    async def one(case: Case, free: asyncio.Semaphore) -> None:
        async with free:
            try:
                futures[str(case)].set_result(await judge(case))
            except BaseException as error:
                futures[str(case)].set_exception(error)
                raise

    async def everything() -> None:
        free = asyncio.Semaphore(JOBS)
        await asyncio.gather(*(one(case, free) for case in ALL))

    loop = asyncio.new_event_loop()
    task = loop.create_task(everything())

    def run() -> None:
        try:
            loop.run_until_complete(task)
        except asyncio.CancelledError:
            pass
        finally:
            loop.close()

    thread = threading.Thread(target=run)
    thread.start()
    yield futures
    if thread.is_alive():
        loop.call_soon_threadsafe(task.cancel)
    thread.join()


@pytest.mark.timeout(600)
@pytest.mark.parametrize("case", ALL, ids=str)
def test_a_submission_is_judged_as_expected(case: Case, outcomes: dict[str, Future[Outcome]]) -> None:
    assert outcomes[str(case)].result(timeout=590).wrong == []


def _result(**statuses: Status) -> ExerciseResult:
    return ExerciseResult(
        "x",
        "X",
        (),
        tuple(
            CriterionResult(name, name, name == "bonus", Verdict(status, cause=f"{name} broke"), 0.0)
            for name, status in statuses.items()
        ),
        0.0,
    )


def _case(**expect: object) -> Case:
    return Case("x", "wrong", ALL[0].folder, expect)


def test_a_false_pass_and_a_false_failure_are_told() -> None:
    """The comparison itself can fail: else every submission would be as expected."""
    mixed = _result(a=Status.FAILED, b=Status.PASSED, bonus=Status.PASSED)
    assert compare(_case(fails=["a"], cause="broke"), mixed).wrong == []
    assert compare(_case(fails=["b"]), mixed).false_pass
    assert compare(_case(fails=["b"]), mixed).false_failure
    assert compare(_case(fails=["a"], bonus_failed=["bonus"]), mixed).false_pass
    assert compare(_case(fails=["a"], cause="no spin"), mixed).wrong == ["a: cause is “a broke”, not no spin"]
    assert compare(_case(passes="all"), _result(a=Status.ERROR)).wrong
    assert compare(_case(passes="all"), _result(a=Status.SKIPPED)).false_failure
    assert compare(_case(not_passed=["a"]), _result(a=Status.PASSED)).false_pass
