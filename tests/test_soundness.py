"""Judge a sample of tests/submissions against their expect.yaml files, small enough to end in minutes.

`tests.sampling` chooses the sample; each is judged by what it shows (`judged_criteria`). Of the wrong ones that are on
record, one of each exercise runs. `python -m tests.soundness` judges all submissions by all criteria. The hostile ones
are judged with the sample (`python -m tests.hostile` shows what they cost), except those in `EXCLUDED`.
"""

from __future__ import annotations

import asyncio
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

import pytest

from tests import soundness
from tests.hostile import find_hostile
from tests.judging import ROOT, Outcome, compare, find_cases, holds_here, judge, laid_out
from tests.recordings.recording import kept_cases
from tests.sameness import JudgedRun, Way, variations
from tests.sampling import changed, judged_criteria, sample, shows
from tutor.content import load_course
from tutor.content.submissions import WRONG, Case, Expected, read_case
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status, Verdict

JOBS = 6
FIRST = {lesson.id: lesson.criteria[0].id for lesson in load_course().lessons}
ALL_CASES, BROKEN = find_cases()
EXCLUDED = {
    "i1.1/hostile/joins-them-all",  # tests/hostile/test_beside.py judges it
    # Slow and expensive; tests/engine/test_bounded_bytes.py covers them.
    "i2.1/hostile/fifty-megabytes-on-the-topic",
    "i2.1/hostile/megabytes-on-the-topic",
    "i2.1/hostile/parameters-of-megabytes",
}
_RECORDED = kept_cases()


def _without_recorded(cases: Sequence[Case]) -> list[Case]:
    """Leave out the wrong ones whose recordings tests judge again (`tests/recordings`), but one of each exercise."""
    wrong = [case for case in cases if case.kind == WRONG]
    real = {case.exercise: case for case in reversed(wrong)}.values()
    return [case for case in cases if case not in wrong or case in real or str(case) not in _RECORDED]


_CHOSEN = [*_without_recorded(sample(ALL_CASES)), *find_hostile()]
_SELECTED = [case for case in _CHOSEN if holds_here(case) and str(case) not in EXCLUDED]
ORDERED_CASES = sorted(
    sorted(_SELECTED, key=lambda case: case.exercise, reverse=True), key=lambda case: not case.expected.keeps_busy
)
"""First the CPU hogs, which are judged one at a time alongside the others; then the longest."""


@pytest.fixture(scope="module")
def outcomes(request: pytest.FixtureRequest) -> Iterator[dict[str, Future[Outcome]]]:
    """Futures of the selected cases' outcomes; several cases are judged in parallel, since a check mostly waits."""
    items = [item for item in request.session.items if isinstance(item, pytest.Function)]
    params = [item.callspec.params["case"] for item in items if "outcomes" in item.fixturenames]
    selected = [case for case in params if isinstance(case, Case)]
    futures: dict[str, Future[Outcome]] = {str(case): Future() for case in selected}

    async def judge_one(case: Case) -> None:
        try:
            with tempfile.TemporaryDirectory() as folder:  # a copy: some submissions change or remove their own files
                own = case
                if not case.changes:
                    own = replace(case, folder=shutil.copytree(case.folder, Path(folder) / case.folder.name))
                outcome = await judge(own, judged_criteria(case, FIRST[case.exercise]))
                futures[str(case)].set_result(outcome)
        except Exception as error:
            futures[str(case)].set_exception(error)  # raised in that case's test; the others continue

    async def judge_all() -> None:
        slots = asyncio.Semaphore(JOBS - 1)

        async def judge_cpu_hogs() -> None:
            for case in selected:
                if case.expected.keeps_busy:
                    await judge_one(case)
            slots.release()

        async def judge_when_free(case: Case) -> None:
            async with slots:
                await judge_one(case)

        others = (judge_when_free(case) for case in selected if not case.expected.keeps_busy)
        await asyncio.gather(judge_cpu_hogs(), *others)

    loop = asyncio.new_event_loop()
    task = loop.create_task(judge_all())

    def run_loop() -> None:
        try:
            loop.run_until_complete(task)
        except asyncio.CancelledError:
            pass
        finally:
            loop.close()

    thread = threading.Thread(target=run_loop)
    thread.start()
    yield futures
    if thread.is_alive():
        loop.call_soon_threadsafe(task.cancel)
    thread.join()


@pytest.mark.timeout(600)
@pytest.mark.parametrize("case", ORDERED_CASES, ids=str)
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


def _case(name: str = "a", kind: str = "wrong", exercise: str = "x1.1", **keys: object) -> Case:
    return Case(exercise, kind, Path(name), Expected("made", **keys))  # type: ignore[arg-type]


def test_every_expect_file_can_be_read() -> None:
    assert [str(error) for error in BROKEN] == []


def test_a_patch_is_judged_as_the_solution_with_its_changes(tmp_path: Path) -> None:
    patch = tmp_path / "i1_1/wrong/other-topic.yaml"
    patch.parent.mkdir(parents=True)
    patch.write_text(
        "says: another topic\nchange: [{from: '\"/sensor/temperature\"', to: '\"/warmth\"'}]\nfails: [publishes]\n"
    )
    with laid_out(read_case(patch)) as case:
        (file,) = case.folder.iterdir()
        assert '"/warmth"' in file.read_text()
    assert not file.exists()


def test_false_passes_and_false_failures_are_detected() -> None:
    """A comparison that never fails would call every submission as expected."""
    mixed = _result(a=Status.FAILED, b=Status.PASSED, bonus=Status.PASSED)
    assert compare(_case(fails=("a",), causes={"": ("Broke",)}), mixed).wrong == []
    assert compare(_case(fails=("b",)), mixed).false_pass
    assert compare(_case(fails=("b",)), mixed).false_failure
    assert compare(_case(fails=("a",), bonus_failed=("bonus",)), mixed).false_pass
    assert compare(_case(fails=("a",), causes={"": ("no spin",)}), mixed).wrong == [
        "a: cause is “a broke”, not no spin"
    ]
    assert compare(_case(fails=("a",), causes={"a": ("no", "broke")}), mixed).wrong == []
    assert compare(_case(fails_any=("b",), either=("a",)), mixed).wrong == ["one of b should fail"]
    assert compare(_case(passes=True), _result(a=Status.ERROR)).wrong[0].startswith("not judged: ")
    assert compare(_case(passes=True), _result(a=Status.SKIPPED)).false_failure
    assert compare(_case(not_passed=("a",)), _result(a=Status.PASSED)).false_pass


def test_the_sample_has_a_right_submission_and_each_criterion_and_cause() -> None:
    cases = [
        *(_case(name, "right") for name in ("r1", "r2", "r3", "r4")),
        _case("one", fails=("a",), causes={"": ("no spin",)}),
        _case("two", fails=("a", "b"), causes={"": ("No spin",)}),
        _case("three", fails=("b",), causes={"b": ("blocked executor", "ramp")}),
        _case("four", bonus_failed=("c",)),
        *(_case(name, fails=("a",), exercise="x1.2") for name in ("five", "six", "seven")),
    ]
    names = [case.folder.name for case in sample(cases)]
    assert names == ["r3", "two", "three", "four", "five"]  # "one" adds nothing to "two"
    assert sample(cases[::-1]) == sample(cases)[::-1]


def test_a_submission_is_judged_by_what_it_breaks_and_a_right_one_by_everything() -> None:
    assert judged_criteria(_case("r1", "right", bonus_failed=("a",)), "first") == ()
    for kind in ("wrong", "hostile"):
        case = _case("one", kind, fails=("b",), fails_any=("a",), bonus_failed=("c",))
        assert judged_criteria(case, "first") == ("a", "b", "c")
    assert judged_criteria(_case("one", "hostile"), "first") == ("first",)
    assert all("no criterion" not in judged_criteria(case, "no criterion") for case in sample(ALL_CASES))


def test_the_real_sample_covers_every_criterion_and_cause() -> None:
    chosen = sample(ALL_CASES)
    assert set().union(*map(shows, chosen)) == set().union(*map(shows, ALL_CASES))
    assert set(Counter(case.exercise for case in chosen if case.kind == "right").values()) == {1}


def test_only_submissions_affected_by_a_change_are_judged() -> None:
    cases = [_case("r1", "right"), _case("one"), _case("two"), _case("three", exercise="x1.2")]

    def names(*paths: str) -> list[str]:
        return [case.folder.name for case in changed(cases, paths)]

    assert names("README.md", "checks/__init__.py") == []
    assert names("tests/submissions/x1_1/wrong/two/expect.yaml") == ["two"]
    assert names("checks/x1_1/judges.py") == names("checks/x1_1_turnstile.py") == ["r1", "one", "two"]
    assert names("lessons/x1_2/solution/a.py") == ["three"]
    assert names("tutor/judge/rates.py") == [case.folder.name for case in sample(cases)]


def test_a_changed_file_affects_submissions_that_link_to_it() -> None:
    path = "tests/submissions/i1_3/right/client-thread-call/calculator_server.py"
    assert {case.folder.name for case in changed(ALL_CASES, [path])} == {
        "client-thread-call",
        "client-best-effort",
        "client-os-exit",
    }


def test_no_client_or_server_file_is_duplicated() -> None:
    """Two submissions of i1.3 that differ in one program only share the other one through a symlink."""
    first: dict[tuple[str, bytes], Path] = {}
    for file in sorted(ROOT.glob("i1_3/*/*/*.py")):
        if not file.is_symlink():
            other = first.setdefault((file.name, file.read_bytes()), file)
            assert other == file, f"{file} is the same as {other}: make it a link"


def _outcome(name: str, verdict: str, took_s: float, *wrong: str) -> Outcome:
    return Outcome(_case(name), list(wrong), took_s=took_s, verdict=verdict, false_pass=bool(wrong))


def test_the_table_counts_runs_and_flaky_submissions_are_listed() -> None:
    outcomes = [
        _outcome("steady", "a:failed b:passed", 1.0),
        _outcome("steady", "a:failed b:passed", 2.0),
        _outcome("shaky", "a:failed b:passed", 3.0),
        _outcome("shaky", "a:passed b:passed", 9.0, "should fail: a"),
    ]
    head, row, total = (line.split() for line in soundness.table(outcomes).splitlines())
    assert head[0] == "exercise"
    assert row == ["x1.1", "wrong", "2", "4", "3", "1", "0", "0", "1.0", "2.5", "9.0"]
    assert total == ["all", *row[2:]]
    assert soundness.flaky(outcomes) == ["x1.1/wrong/shaky:", "    1 times a:failed", "    1 times a:passed"]


def test_each_criterion_whose_status_varies_is_listed_with_the_ways_in_which_it_was_judged() -> None:
    case, same = _case("shaky"), _case("steady")
    runs = [
        JudgedRun(case, Way.APP, {"a": "failed", "b": "passed"}),
        JudgedRun(case, Way.COMMAND_LINE, {"a": "skipped", "b": "passed"}),
        JudgedRun(case, Way.ALONE, {"a": "failed"}),
        JudgedRun(same, Way.FIRST, {"a": "failed"}),
        JudgedRun(same, Way.APP, {"a": "failed", "b": "passed"}),
    ]
    assert variations(runs) == [
        "x1.1/wrong/shaky: a: 2 times failed (app, one criterion alone); 1 times skipped (command line)"
    ]
    assert variations([JudgedRun(same, Way.APP, {}, "no verdict")]) == ["x1.1/wrong/steady: app: no verdict"]


START_LOOPS_AND_DIE = """
import os, signal
from tests import soundness
from tests.hostile import find_hostile
soundness.BUSY_LIMIT_S = 60.0  # if this test fails, the loops end soon all the same
with soundness.busy_cores(2):
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.timeout(100)
def test_busy_loops_end_even_if_their_owner_is_killed_before_they_begin() -> None:
    started = time.monotonic()
    killed = subprocess.run(
        [sys.executable, "-c", START_LOOPS_AND_DIE],
        stdout=subprocess.PIPE,  # EOF shows that the owner and all loops are gone
        cwd=Path(__file__).parents[1],
        check=False,
    )
    assert (killed.returncode, killed.stdout) == (-9, b"")
    assert time.monotonic() - started < 50
