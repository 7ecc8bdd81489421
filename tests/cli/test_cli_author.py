"""`ros-tutor author check`: what is found, what is run, and the exit codes."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

import tutor.engine.proving
from tests.cli.conftest import Run
from tutor.content import Course, Lesson, load_course, loader
from tutor.engine.proving import Kind, Proof
from tutor.errors import EngineError
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Cause, Status, Verdict, failed, fault, passed

LESSON = "i1.3"
OPEN = failed("a", "b", Cause("no spin", "c", "d"))


class Prover:
    """Judges nothing: skeletons fail on what is open, solutions pass, but for `verdicts`."""

    def __init__(self) -> None:
        self.verdicts: dict[tuple[str, str], Verdict] = {}
        self.asked: list[str] = []
        self.raises: Exception | None = None

    async def __call__(self, lessons: list[Lesson], course: Course, on_proof: Callable[[Proof], None]) -> list[Proof]:
        self.asked = [lesson.id for lesson in lessons]
        if self.raises is not None:
            raise self.raises
        proofs = [Proof(lesson, kind, self._judge(lesson, kind)) for kind in Kind for lesson in lessons]
        for proof in proofs:
            on_proof(proof)
        return proofs

    def _judge(self, lesson: Lesson, kind: Kind) -> ExerciseResult:
        def verdict(name: str, is_open: bool) -> Verdict:
            usual = OPEN if is_open and kind is Kind.SKELETON else passed("", "")
            return self.verdicts.get((kind, name), usual)

        criteria = tuple(
            CriterionResult(each.id, each.text, each.bonus, verdict(each.id, each.open), 1.0)
            for each in lesson.criteria
        )
        return ExerciseResult(lesson.id, lesson.title, ("x.py",), criteria, 2.5)


@pytest.fixture
def prover(monkeypatch: pytest.MonkeyPatch) -> Prover:
    prover = Prover()
    monkeypatch.setattr(tutor.engine.proving, "prove", prover)
    return prover


@pytest.fixture
def own(tmp_path: Path) -> Path:
    """A course of an author's own: a copy of one of ours under another id, with its test submissions."""
    root = tmp_path / "own"
    shutil.copytree(loader.BUNDLED / "lessons" / "i1_3", root / "lessons" / "x1_3", ignore=_CACHES)
    shutil.copytree(loader.BUNDLED / "checks" / "i1_3", root / "checks" / "x1_3", ignore=_CACHES)
    shutil.copytree(loader.BUNDLED / "tests" / "submissions" / "i1_3", root / "tests" / "submissions" / "x1_3")
    for file in (root / "lessons/x1_3/lesson.md", root / "checks/x1_3/__init__.py"):
        file.write_text(file.read_text().replace("i1.3", "x1.3"))
    return root


_CACHES = shutil.ignore_patterns("__pycache__")


def test_a_right_exercise_is_0_and_nothing_is_wrong(run: Run, prover: Prover) -> None:
    ran = run("author", "check", LESSON)
    assert (ran.code, ran.out) == (0, "nothing is wrong: 1 exercise, 2 runs\n")
    assert ran.err.splitlines() == [
        "ros-tutor: i1.3 skeleton: failed in 2.5 s",
        "ros-tutor: i1.3 solution: passed in 2.5 s",
    ]
    assert prover.asked == [LESSON]


def test_static_runs_nothing(run: Run, prover: Prover) -> None:
    ran = run("author", "check", LESSON, "--static")
    assert (ran.code, ran.out, ran.err) == (0, "nothing is wrong: 1 exercise, nothing was run\n", "")
    assert prover.asked == []


def test_all_exercises_are_proven_where_none_is_named(run: Run, prover: Prover) -> None:
    run("author", "check")
    assert prover.asked == [lesson.id for lesson in load_course().lessons]


def test_what_the_runs_show_is_1_and_a_line_each(run: Run, prover: Prover) -> None:
    prover.verdicts = {
        (Kind.SKELETON, "services"): passed("", ""),
        (Kind.SOLUTION, "client"): OPEN,
        (Kind.SOLUTION, "operations"): fault("too busy", "wait"),
    }
    ran = run("author", "check", LESSON)
    assert ran.code == 1
    skeleton, solution, unjudged, summary = ran.out.splitlines()
    assert skeleton.partition(": ")[0].endswith("lessons/i1_3/skeleton")
    assert "services passes, but the lesson says that it is open" in skeleton
    assert "client does not pass (b | no spin: c)" in solution
    assert unjudged == "i1.3 solution, operations: could not be judged: too busy; wait"
    assert summary == "2 findings, 1 could not be judged: 1 exercise, 2 runs"


def test_what_could_not_be_judged_is_not_a_finding_but_3(run: Run, prover: Prover) -> None:
    prover.verdicts = {(Kind.SOLUTION, "client"): Verdict(Status.ERROR, cause="too busy", hint="wait")}
    ran = run("author", "check", LESSON)
    assert ran.code == 3
    assert ran.out.splitlines()[-1] == "nothing is wrong, 1 could not be judged: 1 exercise, 2 runs"


def test_a_fault_of_the_engine_is_3(run: Run, prover: Prover) -> None:
    prover.raises = EngineError("no ROS here", "run the doctor")
    ran = run("author", "check", LESSON)
    assert ran.code == 3
    assert "no ROS here; run the doctor" in ran.err


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["author"], "the following arguments are required: ACTION"),
        (["author", "prove"], "invalid choice: 'prove'"),
        (["author", "check", "i9.9"], "There is no exercise 'i9.9'"),
        (["author", "check", "i1.3", "--submissions", "nowhere"], "--submissions nowhere: there is no such folder"),
    ],
)
def test_wrong_usage_is_2(run: Run, prover: Prover, argv: list[str], message: str) -> None:
    ran = run(*argv)
    assert (ran.code, ran.out) == (2, "")
    assert message in ran.err


def test_an_authors_own_course_is_proven_alone(run: Run, prover: Prover, own: Path) -> None:
    ran = run("author", "check", "--lessons", own)
    # The commands of the copied lesson are about the other exercise.
    assert all("`ros-tutor" in line for line in ran.out.splitlines()[:-1])
    assert prover.asked == ["x1.3"]


def test_findings_of_every_kind_come_in_one_go(run: Run, prover: Prover, own: Path) -> None:
    (own / "lessons/x1_3/notes.txt").touch()
    (own / "checks/stray.py").touch()
    shutil.rmtree(own / "tests/submissions/x1_3/wrong")
    ran = run("author", "check", "--lessons", own, "--static")
    assert ran.code == 1
    for text in ("notes.txt: this file belongs to no lesson", "stray.py: this belongs to no lesson", "breaks client"):
        assert text in ran.out


@pytest.mark.parametrize("source", ["CHECK = 1\n", "import nothing_of_that_name\n", "CHECK = (\n"])
def test_a_check_that_cannot_be_loaded_is_a_finding_and_not_run(
    run: Run, prover: Prover, own: Path, source: str
) -> None:
    (own / "checks/x1_3/__init__.py").write_text(source)
    ran = run("author", "check", "--lessons", own)
    assert ran.code == 1
    assert "checks/x1_3/__init__.py: it cannot be loaded: " in ran.out
    assert prover.asked == []


def test_a_lesson_that_cannot_be_read_is_a_finding(run: Run, prover: Prover, own: Path) -> None:
    (own / "lessons/x1_3/lesson.md").write_text("---\nid: x1.3\n---\n")
    ran = run("author", "check", "--lessons", own)
    assert ran.code == 1
    assert ran.out.splitlines()[-1] == "1 finding: the course cannot be read"


def test_without_submissions_it_says_what_is_not_proven(run: Run, prover: Prover, own: Path) -> None:
    shutil.move(own / "tests/submissions", own / "elsewhere")
    ran = run("author", "check", "--lessons", own, "--static")
    assert "no test submissions in" in ran.err
    assert "no submission breaks" not in ran.out
    ran = run("author", "check", "--lessons", own, "--static", "--submissions", own / "elsewhere")
    assert ran.err == ""
