"""What is checked, kept, repeated and written, with an executor that only pretends to check."""

from __future__ import annotations

import asyncio
import json
import shutil
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from tests.grade.made import ENVIRONMENT, FAULT, RATE
from tests.waiting import wait_for
from tutor.content import Course, load_course
from tutor.errors import StorageError
from tutor.grade.capacity import Cost
from tutor.grade.grading import Grading, LocalExecutor, Options, Plan, course_digest
from tutor.grade.results import Result, ResultFolder, encode
from tutor.grade.roster import Roster
from tutor.grade.unit import OnEvent, Outcome, Unit
from tutor.grade.work import Work, find_work
from tutor.judge.events import CheckFinished
from tutor.judge.result import CriterionResult, ExerciseResult, Report
from tutor.judge.verdict import Verdict, passed

PUBLISHER, LAUNCH = "temperature_publisher.py", "my_launch.py"
Judge = Callable[[Unit, int], Verdict | str]
"""Gets a unit and which attempt this is; returns the verdict of all its criteria, or a fault."""


def always_passes(unit: Unit, attempt: int) -> Verdict | str:
    return passed("x", "y")


class Executor:
    """Pretends to check. `runs` holds the keys of the units in order, `most` how many ran at once at most.

    `waits`: the keys and attempts that wait for `go`; once all others are done, `waiting` is set.
    """

    def __init__(self, course: Course, judge: Judge = always_passes, slots: int = 3) -> None:
        self.slots = slots
        self.runs: list[str] = []
        self.units: list[Unit] = []
        self.most = 0
        self.cancelled = 0
        self.waits: set[tuple[str, int]] = set()
        self.waiting, self.go = asyncio.Event(), asyncio.Event()
        self._course = course
        self._judge = judge
        self._running = 0

    async def run(self, unit: Unit, on_event: OnEvent) -> Outcome:
        self.runs.append(unit.key)
        self.units.append(unit)
        self._running += 1
        self.most = max(self.most, self._running)
        try:
            if (unit.key, self.runs.count(unit.key)) in self.waits:
                self.waiting.set()
                await self.go.wait()
        except asyncio.CancelledError:
            await asyncio.sleep(0)
            self.cancelled += 1
            raise
        finally:
            self._running -= 1
        verdict = self._judge(unit, self.runs.count(unit.key))
        if isinstance(verdict, str):
            return Outcome(None, 0.5, verdict)
        lesson = self._course.find(unit.exercise)
        criteria = tuple(CriterionResult(each.id, each.text, each.bonus, verdict, 1.0) for each in lesson.criteria)
        files = tuple(file.name for file in lesson.files)
        report = Report(ENVIRONMENT, (ExerciseResult(lesson.id, lesson.title, files, criteria, 2.0),), 2.5)
        on_event(CheckFinished(report))
        return Outcome(report, 1.5)


class Watcher:
    """Notes what it is told."""

    def __init__(self) -> None:
        self.told: list[str] = []
        self.on_finished: Callable[[Result], None] = lambda result: None

    def started(self, work: Work) -> None:
        self.told.append(f"started {work.learner.id} {work.exercise}")

    def event(self, work: Work) -> OnEvent:
        return lambda event: self.told.append(f"event {work.learner.id} {work.exercise}")

    def finished(self, result: Result) -> None:
        self.told.append(f"finished {result.learner.id} {result.exercise} {result.status}")
        self.on_finished(result)


class Class:
    """A class of three, of whom one handed in nothing, and its results."""

    def __init__(self, folder: Path, course: Course) -> None:
        self.course = course
        self.submissions = folder / "class"
        self.results = ResultFolder(folder / "results")
        self._scratch = folder / "scratch"
        self._scratch.mkdir()
        for name in (f"ana/{PUBLISHER}", f"ana/i2.2/{LAUNCH}", f"ben/{PUBLISHER}", f"ben/i2.2/{LAUNCH}"):
            self.write(name, f"# {name}")
        (self.submissions / "cy").mkdir()

    def write(self, name: str, text: str) -> None:
        path = self.submissions / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def works(self, roster: Roster | None = None) -> list[Work]:
        return find_work(self.submissions, self.course, self._scratch, roster=roster)

    def grading(self) -> Grading:
        return Grading(self.course, self.results)

    async def grade(
        self, executor: Executor, *, again: bool = False, watcher: Watcher | None = None, roster: Roster | None = None
    ) -> list[Result]:
        grading = self.grading()
        plan = grading.plan(self.works(roster), again=again)
        return await grading.grade(plan, executor, Options(), watcher or Watcher())

    def files(self) -> dict[str, str]:
        """Return the results by name, without their times."""
        return {
            str(path.relative_to(self.results.root)): path.read_text()
            for path in self.results.root.rglob("*")
            if path.is_file()
        }

    def names(self, plan: Plan) -> tuple[list[str], list[str], list[str]]:
        parts: Sequence[Sequence[Work | Result]] = (plan.todo, plan.missing, plan.kept)
        first, second, third = ([f"{each.learner.id} {each.exercise}" for each in part] for part in parts)
        return first, second, third


@pytest.fixture(scope="module")
def course() -> Course:
    return load_course()


@pytest.fixture
def made(tmp_path: Path, course: Course) -> Class:
    return Class(tmp_path, course)


ALL = ["ana i1.1", "ana i2.2", "ben i1.1", "ben i2.2"]
NOTHING = ["cy i1.1", "cy i2.2"]


async def test_everything_is_checked_once(made: Class) -> None:
    executor, watcher = Executor(made.course), Watcher()
    executor.waits = {(name.replace(" ", "/"), 1) for name in ALL}
    grading = asyncio.ensure_future(made.grade(executor, watcher=watcher))
    assert await wait_for(lambda: executor.most == 3, 60)
    executor.go.set()
    results = await grading
    assert sorted(executor.runs) == ["ana/i1.1", "ana/i2.2", "ben/i1.1", "ben/i2.2"]
    assert executor.most == 3
    assert Counter(result.status for result in results) == {"passed": 4, "missing": 2}
    assert sorted(made.files()) == [f"{name.replace(' ', '/')}.json" for name in sorted(ALL + NOTHING)]
    assert {encode(result) for result in results} == set(made.files().values())
    assert watcher.told[:2] == ["finished cy i1.1 missing", "finished cy i2.2 missing"]
    for name in ALL:
        places = [
            watcher.told.index(f"{what} {name}{ending}")
            for what, ending in (("started", ""), ("event", ""), ("finished", " passed"))
        ]
        assert places == sorted(places)
    assert all(result.cpu_s == 1.5 for result in results if result.status == "passed")


async def test_what_is_current_is_kept(made: Class) -> None:
    await made.grade(Executor(made.course))
    before = made.files()
    times = {path: path.stat().st_mtime_ns for path in made.results.root.rglob("*.json")}
    executor = Executor(made.course)
    results = await made.grade(executor)
    assert executor.runs == []
    assert len(results) == 6
    assert made.files() == before
    assert {path: path.stat().st_mtime_ns for path in made.results.root.rglob("*.json")} == times
    again = Executor(made.course)
    await made.grade(again, again=True)
    assert len(again.runs) == 4


async def test_what_changed_is_checked_again(made: Class, monkeypatch: pytest.MonkeyPatch) -> None:
    await made.grade(Executor(made.course))

    def todo() -> list[str]:
        return made.names(made.grading().plan(made.works()))[0]

    assert todo() == []
    made.write(f"ana/i2.2/{LAUNCH}", "# changed")
    assert todo() == ["ana i1.1", "ana i2.2"]  # it is in the folder of the other, too
    made.write(f"ana/i2.2/{LAUNCH}", f"# ana/i2.2/{LAUNCH}")
    assert todo() == []
    made.write("ben/i2.2/helper.py", "")
    assert todo() == ["ben i1.1", "ben i2.2"]
    shutil.rmtree(made.submissions / "ben" / "i2.2")
    plan = made.grading().plan(made.works())
    assert made.names(plan) == (["ben i1.1"], ["ben i2.2", *NOTHING], ["ana i1.1", "ana i2.2"])
    made.write(f"cy/{PUBLISHER}", "#")
    assert todo() == ["ben i1.1", "cy i1.1"]
    monkeypatch.setattr("tutor.grade.grading.__version__", "99")
    assert len(todo()) == 4


async def test_a_check_that_changed_judges_again(made: Class, tmp_path: Path) -> None:
    root = Path(__file__).parents[2]
    for name in ("lessons", "checks"):
        shutil.copytree(root / name, tmp_path / "course" / name, ignore=shutil.ignore_patterns("__pycache__"))
    lesson = made.course.find("i1.1")
    moved = replace(
        lesson,
        folder=tmp_path / "course" / "lessons" / "i1_1",
        files=tuple(
            replace(file, skeleton=tmp_path / "course" / "lessons" / "i1_1" / "skeleton" / file.name)
            for file in lesson.files
        ),
    )
    digests = {course_digest(lesson)}
    assert course_digest(moved) in digests  # the place does not count
    checks = tmp_path / "course" / "checks"
    (checks / "__pycache__").mkdir()
    for file in (
        checks / "__pycache__" / "x.pyc",
        checks / "i2_1_parameterized_publisher.py",
        checks / "i1_2_message_statistics" / "trial.py",
    ):
        file.write_text("# changed")
    assert course_digest(moved) in digests
    for file in (
        checks / lesson.check.name,
        checks / "__init__.py",
        moved.folder / "lesson.md",
        moved.files[0].skeleton,
    ):
        file.write_text("# changed")
        digests.add(course_digest(moved))
    assert len(digests) == 5


@pytest.mark.parametrize("text", ["", "{", '{"schema": "ros-tutor/result/2"}'])
async def test_a_result_that_cannot_be_read_is_made_again(made: Class, text: str) -> None:
    await made.grade(Executor(made.course))
    before = set(made.files())
    (made.results.root / "ana" / "i1.1.json").write_text(text)
    executor = Executor(made.course)
    await made.grade(executor)
    assert executor.runs == ["ana/i1.1"]
    assert set(made.files()) == before
    json.loads(made.files()["ana/i1.1.json"])


async def test_an_error_is_repeated_once_alone_at_the_end(made: Class) -> None:
    def judge(unit: Unit, attempt: int) -> Verdict | str:
        if unit.key == "ana/i1.1":
            return FAULT
        if unit.key == "ben/i2.2" and attempt == 1:
            return "the process vanished"
        return passed("x", "y")

    executor, watcher = Executor(made.course, judge), Watcher()
    results = {f"{each.learner.id} {each.exercise}": each for each in await made.grade(executor, watcher=watcher)}
    assert len(results) == 6
    assert sorted(executor.runs[:4]) == ["ana/i1.1", "ana/i2.2", "ben/i1.1", "ben/i2.2"]
    assert sorted(executor.runs[4:]) == ["ana/i1.1", "ben/i2.2"]
    assert [(results[name].status, results[name].attempt) for name in ALL] == [
        *(("error", 2), ("passed", 1), ("passed", 1), ("passed", 2))
    ]
    assert watcher.told.count("finished ben i2.2 error") == watcher.told.count("finished ben i2.2 passed") == 1
    # A second start judges errors again, and nothing else.
    again = Executor(made.course)
    assert {each.status for each in await made.grade(again)} == {"passed", "missing"}
    assert again.runs == ["ana/i1.1"]


async def test_repeats_run_alone(made: Class) -> None:
    executor = Executor(made.course, lambda unit, attempt: "no" if attempt == 1 else passed("x", "y"))
    running: list[int] = []
    judge = executor._judge

    def note(unit: Unit, attempt: int) -> Verdict | str:
        running.append(executor._running)
        return judge(unit, attempt)

    executor._judge = note
    await made.grade(executor)
    assert running[4:] == [0, 0, 0, 0]  # besides itself


async def test_a_better_first_attempt_stays(made: Class) -> None:
    """Only a bonus was not judged at first; then everything fails."""
    bonus = {each.id for each in made.course.find("i1.1").criteria if each.bonus}
    executor = Executor(made.course)
    run = executor.run

    async def run_badly(unit: Unit, on_event: OnEvent) -> Outcome:
        outcome = await run(unit, on_event)
        if unit.key != "ana/i1.1":
            return outcome
        if executor.runs.count(unit.key) > 1:
            return Outcome(None, fault="nothing worked")
        assert outcome.report is not None
        judged = outcome.report.exercises[0]
        criteria = tuple(replace(each, verdict=FAULT) if each.id in bonus else each for each in judged.criteria)
        return replace(outcome, report=replace(outcome.report, exercises=(replace(judged, criteria=criteria),)))

    executor.run = run_badly  # type: ignore[method-assign]
    results = {f"{each.learner.id} {each.exercise}": each for each in await made.grade(executor)}
    assert executor.runs.count("ana/i1.1") == 2
    assert (results["ana i1.1"].status, results["ana i1.1"].unjudged) == ("passed", True)
    assert json.loads(made.files()["ana/i1.1.json"])["status"] == "passed"


async def test_results_are_written_as_they_come(made: Class) -> None:
    executor, watcher = Executor(made.course), Watcher()
    executor.waits = {("ben/i1.1", 1)}
    seen: list[int] = []

    def look(result: Result) -> None:
        assert made.results.read(result.learner, result.exercise) == result
        seen.append(len(made.files()))
        if len(seen) == 5:  # all but the one that waits
            executor.go.set()

    watcher.on_finished = look
    await asyncio.wait_for(made.grade(executor, watcher=watcher), 60)
    assert seen == [1, 2, 3, 4, 5, 6]
    assert not [name for name in made.files() if not name.endswith(".json")]


async def test_files_that_change_meanwhile_are_a_fault(made: Class) -> None:
    executor = Executor(made.course)
    grading = made.grading()
    plan = grading.plan(made.works())
    made.write(f"ana/{PUBLISHER}", "# changed after it was found")
    (made.submissions / "ben" / PUBLISHER).unlink()
    graded = await grading.grade(plan, executor, Options(), Watcher())
    results = {f"{each.learner.id} {each.exercise}": each for each in graded}
    assert {name: result.report.message for name, result in results.items() if result.status == "error"} == {
        "ana i1.1": "the files were changed while the class was graded",
        "ben i1.1": f"{made.submissions / 'ben' / PUBLISHER} cannot be read: No such file or directory",
    }
    assert sorted(executor.runs) == ["ana/i2.2", "ben/i2.2"]
    assert {each.status for each in await made.grade(Executor(made.course))} == {"passed", "missing"}


async def test_what_could_not_be_read_is_a_fault_even_if_it_was_missing_before(made: Class) -> None:
    await made.grade(Executor(made.course))
    broken = [
        replace(work, missing="", lookup=None, fault="cy cannot be read: no") for work in made.works() if work.missing
    ]
    grading = made.grading()
    plan = grading.plan(broken)
    assert made.names(plan) == (NOTHING, [], [])
    results = await grading.grade(plan, Executor(made.course), Options(), Watcher())
    assert {(each.status, each.report.message) for each in results} == {("error", "cy cannot be read: no")}


async def test_missing_work_says_what_was_looked_for_and_nothing_of_start(made: Class) -> None:
    made.write("cy/temperature_publsher.py", "")
    results = await made.grade(Executor(made.course))
    text = made.files()["cy/i1.1.json"]
    judged = next(each.judged for each in results if each.learner.id == "cy" and each.exercise == "i1.1")
    assert judged is not None
    assert judged.missing == f"there is no {PUBLISHER} (temperature_publsher.py is there)"
    assert judged.lookup is not None
    assert (judged.lookup.looked_for, judged.lookup.found) == ((PUBLISHER,), ("temperature_publsher.py",))
    assert "ros-tutor start" not in text
    assert "not started" not in text


async def test_a_new_roster_changes_what_is_said_of_a_learner(made: Class) -> None:
    await made.grade(Executor(made.course))
    executor = Executor(made.course)
    rows = [{"folder": "ana", "name": "Ana Ruiz", "email": "ana@example.org"}]
    results = await made.grade(executor, roster=Roster(rows))
    assert executor.runs == []
    assert {each.learner.name for each in results} == {"Ana Ruiz", "ben", "cy"}
    learner = json.loads(made.files()["ana/i1.1.json"])["learner"]
    assert (learner["name"], learner["email"], learner["columns"]) == ("Ana Ruiz", "ana@example.org", rows[0])


async def test_long_checks_come_first(made: Class) -> None:
    executor = Executor(made.course, slots=1)
    grading = made.grading()
    costs = {"i1.1": Cost(1, 5), "i2.2": Cost(1, 9)}
    await grading.grade(grading.plan(made.works()), executor, Options(), Watcher(), costs)
    assert executor.runs == ["ana/i2.2", "ben/i2.2", "ana/i1.1", "ben/i1.1"]
    assert executor.most == 1


async def test_a_unit_has_what_its_process_needs(made: Class, tmp_path: Path) -> None:
    executor = Executor(made.course)
    grading = made.grading()
    options = Options(isolate=False, limit_s=7.0, lessons=tmp_path)
    await grading.grade(grading.plan(made.works()), executor, options, Watcher())
    unit = next(unit for unit in executor.units if unit.key == "ana/i2.2")
    assert (unit.exercise, unit.main, unit.isolate, unit.limit_s, unit.lessons) == ("i2.2", ".", False, 7.0, tmp_path)
    assert all("ana" not in unit.main and b"/ana" not in unit.packed for unit in executor.units)


async def test_a_full_disk_ends_grading_and_all_checks(made: Class) -> None:
    executor = Executor(made.course)
    executor.waits = {("ben/i1.1", 1), ("ben/i2.2", 1)}
    made.results.root.mkdir()
    (made.results.root / "ana").write_text("in the way")
    with pytest.raises(StorageError, match="cannot create"):
        await asyncio.wait_for(made.grade(executor), 60)
    assert executor._running == 0
    assert not [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]


@pytest.mark.parametrize("repeating", [False, True])
async def test_cancelled_grading_leaves_what_was_judged(made: Class, repeating: bool) -> None:
    executor, watcher = Executor(made.course, slots=2), Watcher()
    executor.waits = {("ben/i1.1", 2 if repeating else 1)}
    if repeating:
        executor._judge = lambda unit, attempt: "no" if unit.key == "ben/i1.1" else passed("x", "y")
    task = asyncio.ensure_future(made.grade(executor, watcher=watcher))
    assert await wait_for(lambda: executor.waiting.is_set() and len(made.files()) == (6 if repeating else 5), 60)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    assert executor.cancelled == 1
    assert executor._running == 0
    done = {name for name, text in made.files().items() if json.loads(text)["status"] in ("passed", "missing")}
    assert len(done) == 5
    rest = Executor(made.course)
    await made.grade(rest)
    assert rest.runs == ["ben/i1.1"]


async def test_failures_are_kept_as_well(made: Class) -> None:
    await made.grade(Executor(made.course, lambda unit, attempt: RATE))
    executor = Executor(made.course)
    assert Counter(each.status for each in await made.grade(executor)) == {"failed": 4, "missing": 2}
    assert executor.runs == []


def test_the_local_executor_says_how_much_it_does_at_once() -> None:
    assert LocalExecutor(3).slots == 3
