"""`ros-tutor author check`: its findings, what it runs, and the exit codes."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

import tutor.cli.author_predictions
import tutor.engine.verification
from tests.cli.conftest import Run
from tests.failures import failure
from tutor.cli.author_predictions import run_programs
from tutor.content import Course, load_course, loader
from tutor.content.submissions import Expected
from tutor.engine.verification import Job, Kind, Proof
from tutor.errors import EngineError
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status, Verdict, fault, passed, skipped

LESSON = "i1.3"
OPEN_FAILURE = failure("a", "b", ("no spin", "c", "d"))


class FakeProver:
    """Judges nothing: skeletons fail their open criteria and solutions pass, except for `verdicts`."""

    def __init__(self) -> None:
        self.verdicts: dict[tuple[str, str], Verdict] = {}
        self.proven: list[str] = []
        self.submissions: list[str] = []
        self.raises: Exception | None = None

    async def __call__(self, jobs: list[Job], course: Course, on_proof: Callable[[Proof], None]) -> list[Proof]:
        self.proven = list(dict.fromkeys(job.lesson.id for job in jobs))
        self.submissions = [job.name for job in jobs if job.kind is Kind.SUBMISSION]
        if self.raises is not None:
            raise self.raises
        proofs = [Proof(job, self._judge(job)) for job in jobs]
        for proof in proofs:
            on_proof(proof)
        return proofs

    def _judge(self, job: Job) -> ExerciseResult:
        lesson, kind = job.lesson, job.kind

        def verdict(name: str, is_open: bool) -> Verdict:
            expected = job.case.expected if job.case is not None else Expected("")
            causes = expected.causes.get(name, expected.causes.get("", ()))
            fails = failure("a", "b", (causes[0], "c", "d")) if causes else OPEN_FAILURE
            named = name in (*expected.fails, *expected.fails_any, *expected.bonus_failed)
            if name in expected.not_passed:
                return skipped("it depends on what fails")
            default = fails if named or (is_open and kind is Kind.SKELETON) else passed("", "")
            return self.verdicts.get((kind, name), default)

        criteria = tuple(
            CriterionResult(each.id, each.text, each.bonus, verdict(each.id, each.open), 1.0)
            for each in lesson.criteria
        )
        return ExerciseResult(lesson.id, lesson.title, ("x.py",), criteria, 2.5)


@pytest.fixture
def prover(monkeypatch: pytest.MonkeyPatch) -> FakeProver:
    prover = FakeProver()
    monkeypatch.setattr(tutor.engine.verification, "prove", prover)
    monkeypatch.setattr(tutor.cli.author_predictions, "run_programs", lambda lessons: (0, []))
    return prover


@pytest.fixture
def own_course(tmp_path: Path) -> Path:
    """A course of an author's own: a copy of one of ours under another id, with its test submissions."""
    root = tmp_path / "own"
    shutil.copytree(loader.BUNDLED / "lessons" / "i1_3", root / "lessons" / "x1_3", ignore=_CACHES)
    (root / "checks").mkdir()
    shutil.copy(loader.BUNDLED / "checks" / "i1_3_calculator_service.py", root / "checks" / "x1_3.py")
    shutil.copytree(loader.BUNDLED / "tests" / "submissions" / "i1_3", root / "tests" / "submissions" / "x1_3")
    for file in (root / "lessons/x1_3/lesson.md", root / "checks/x1_3.py"):
        file.write_text(file.read_text().replace("i1.3", "x1.3"))
    (root / "course.yaml").write_text("format: 1\nname: own\n")
    return root


_CACHES = shutil.ignore_patterns("__pycache__")


def test_a_correct_exercise_has_no_findings_and_exits_0(run: Run, prover: FakeProver) -> None:
    result = run("author", "check", LESSON)
    assert (result.code, result.out) == (0, "nothing is wrong: 1 exercise, 2 runs\n")
    assert result.err.splitlines() == [
        "ros-tutor: i1.3 skeleton: failed in 2.5 s",
        "ros-tutor: i1.3 solution: passed in 2.5 s",
    ]
    assert prover.proven == [LESSON]


def test_static_runs_nothing(run: Run, prover: FakeProver) -> None:
    result = run("author", "check", LESSON, "--static")
    assert (result.code, result.out, result.err) == (0, "nothing is wrong: 1 exercise, nothing was run\n", "")
    assert prover.proven == []


def test_all_exercises_are_proven_if_none_is_named(run: Run, prover: FakeProver) -> None:
    run("author", "check")
    assert prover.proven == [lesson.id for lesson in load_course().lessons]


def test_findings_of_the_runs_are_one_line_each_and_exit_1(run: Run, prover: FakeProver) -> None:
    prover.verdicts = {
        (Kind.SKELETON, "services"): passed("", ""),
        (Kind.SOLUTION, "client"): OPEN_FAILURE,
        (Kind.SOLUTION, "operations"): fault("too busy", "wait"),
    }
    result = run("author", "check", LESSON)
    assert result.code == 1
    skeleton, solution, unjudged, summary = result.out.splitlines()
    assert skeleton.partition(": ")[0].endswith("lessons/i1_3/skeleton")
    assert "services passes, but the lesson says that it is open" in skeleton
    assert "client does not pass (b | no spin: c)" in solution
    assert unjudged == "i1.3 solution, operations: could not be judged: too busy; wait"
    assert summary == "2 findings, 1 could not be judged: 1 exercise, 2 runs"


PREDICTIONS = """\
predictions:
  - id: one
    program: predict/program.py
    asks: What is written?
    options:
      - {says: one, seen: "1$"}
      - {says: two, seen: "2$"}
    because: So it is.
"""


@pytest.mark.parametrize(
    ("program", "problem"),
    [
        ("print(2)", ""),
        ("print(3)", "none of the options can be told from what program.py has written"),
        ("print(1); print(2)", "2 options can be told from what program.py has written"),
        ("print(1); raise SystemExit('no')", "program.py ended by itself with exit code 1"),
    ],
)
def test_exactly_one_option_of_a_prediction_must_hold(
    run: Run, prover: FakeProver, own_course: Path, monkeypatch: pytest.MonkeyPatch, program: str, problem: str
) -> None:
    monkeypatch.setattr(tutor.cli.author_predictions, "run_programs", run_programs)
    folder = own_course / "lessons" / "x1_3"
    shutil.rmtree(folder / "predict", ignore_errors=True)
    (folder / "predict").mkdir()
    (folder / "predict/program.py").write_text(program)
    (folder / "predictions.yaml").write_text(PREDICTIONS)
    result = run("author", "check", "x1.3", "--lessons", own_course)
    *findings, summary = result.out.splitlines()
    if problem:
        (finding,) = [line for line in findings if "predictions.yaml" in line]
        hint = "exactly one option must hold, however busy the machine is"
        assert finding.endswith(f"predictions.yaml:2: the prediction one: {problem}; {hint}")
        assert result.code == 1
    else:
        assert findings == []
        assert "ros-tutor: x1.3 one: two" in result.err.splitlines()
        assert summary.startswith("nothing is wrong: ")


def test_what_could_not_be_judged_is_not_a_finding_and_exits_3(run: Run, prover: FakeProver) -> None:
    prover.verdicts = {(Kind.SOLUTION, "client"): Verdict(Status.ERROR, cause="too busy", step="wait")}
    result = run("author", "check", LESSON)
    assert result.code == 3
    assert result.out.splitlines()[-1] == "nothing is wrong, 1 could not be judged: 1 exercise, 2 runs"


def test_an_engine_error_exits_3(run: Run, prover: FakeProver) -> None:
    prover.raises = EngineError("no ROS here", "run the doctor")
    result = run("author", "check", LESSON)
    assert result.code == 3
    assert "no ROS here; run the doctor" in result.err


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["author"], "the following arguments are required: ACTION"),
        (["author", "prove"], "invalid choice: 'prove'"),
        (["author", "check", "i9.9"], "There is no exercise 'i9.9'"),
        (["author", "check", "i1.3", "--submissions", "nowhere"], "--submissions nowhere: there is no such folder"),
    ],
)
def test_wrong_usage_exits_2(run: Run, prover: FakeProver, argv: list[str], message: str) -> None:
    result = run(*argv)
    assert (result.code, result.out) == (2, "")
    assert message in result.err


def test_an_authors_own_course_is_proven_alone(run: Run, prover: FakeProver, own_course: Path) -> None:
    result = run("author", "check", "--lessons", own_course)
    # The only findings: the commands in the copied lesson still name the original exercise.
    assert [line for line in result.out.splitlines()[:-1] if "`ros-tutor" not in line] == []
    assert prover.proven == ["x1.3"]
    assert "x1.3/wrong/divide-reversed" in prover.submissions


def test_submissions_to_our_own_exercises_are_judged_only_when_named(run: Run, prover: FakeProver) -> None:
    run("author", "check", LESSON)
    assert prover.submissions == []
    result = run("author", "check", f"{LESSON}/wrong/divide-reversed")
    assert prover.submissions == [f"{LESSON}/wrong/divide-reversed"]
    assert result.err.splitlines()[-1].startswith(f"ros-tutor: {LESSON}/wrong/divide-reversed: failed")


def test_findings_of_every_kind_are_reported_together(run: Run, prover: FakeProver, own_course: Path) -> None:
    (own_course / "lessons/x1_3/notes.txt").touch()
    (own_course / "checks/stray.py").touch()
    shutil.rmtree(own_course / "tests/submissions/x1_3/wrong")
    result = run("author", "check", "--lessons", own_course, "--static")
    assert result.code == 1
    for text in ("notes.txt: this file belongs to no lesson", "stray.py: this belongs to no lesson", "breaks client"):
        assert text in result.out


@pytest.mark.parametrize(
    ("source", "place", "text"),
    [
        ("CHECK = 1\n", "", "it defines no CHECK: assign a Check to CHECK"),
        ("\nimport nothing_of_that_name\n", ":2", "ModuleNotFoundError: No module named 'nothing_of_that_name'"),
        ("X = 1\nCHECK = (\n", ":2", "'(' was never closed"),
        (
            "from tutor.judge.check import Check, Criterion\nCHECK = Check('x1.3', (Criterion('a'),))\n",
            ":2",
            "TypeError: Criterion.__init__() missing 2 required positional arguments: 'judge' and 'facts'",
        ),
        (
            "from tutor.judge.check import Check\nTYPE = 'std_msgs/msg/Strng'\nCHECK = Check('x1.3', ())\n",
            ":2",
            "this ROS has no type std_msgs/msg/Strng; did you mean std_msgs/msg/String?",
        ),
        (
            "from tutor.judge.check import Check\nTYPE = 'rain_msgs/msg/Drop'\nCHECK = Check('x1.3', ())\n",
            ":2",
            "this ROS has no type rain_msgs/msg/Drop; correct the name of the package, or install it "
            "(apt install ros-jazzy-rain-msgs)",
        ),
    ],
)
def test_a_check_that_cannot_be_loaded_is_a_finding_with_its_line_and_is_not_run(
    run: Run, prover: FakeProver, own_course: Path, source: str, place: str, text: str
) -> None:
    (own_course / "checks/x1_3.py").write_text(source)
    result = run("author", "check", "--lessons", own_course)
    assert result.code == 1
    assert f"checks/x1_3.py{place}: your check: {text}" in [
        line.removeprefix(f"{own_course}/") for line in result.out.splitlines()
    ]
    assert prover.proven == []


def test_a_lesson_that_cannot_be_read_is_a_finding(run: Run, prover: FakeProver, own_course: Path) -> None:
    (own_course / "lessons/x1_3/lesson.md").write_text("---\nid: x1.3\n---\n")
    result = run("author", "check", "--lessons", own_course)
    assert result.code == 1
    assert result.out.splitlines()[-1] == "1 finding: the course cannot be read"


def test_missing_test_submissions_are_reported_and_prove_nothing(
    run: Run, prover: FakeProver, own_course: Path
) -> None:
    shutil.move(own_course / "tests/submissions", own_course / "elsewhere")
    result = run("author", "check", "--lessons", own_course, "--static")
    assert "no test submissions in" in result.err
    assert "no submission breaks" not in result.out
    result = run("author", "check", "--lessons", own_course, "--static", "--submissions", own_course / "elsewhere")
    assert result.err == ""
