"""Grading: what is kept, checked, repeated and written, with checks that are made up; and points."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tutor.content import load_course
from tutor.errors import UsageError
from tutor.grade.formats import csv_table, text
from tutor.grade.gradebook import Gradebook
from tutor.grade.grading import Grading, Options
from tutor.grade.points import Points
from tutor.grade.results import Result, ResultFolder, decode, encode
from tutor.grade.submissions import Work, find_work
from tutor.grade.unit import OnEvent, Outcome, Unit
from tutor.judge.result import CriterionResult, ExerciseResult, Remark, Report
from tutor.judge.verdict import Status, Verdict
from tutor.ros.environment import detect

COURSE = load_course()
LESSON = COURSE.find("i1.1")
FILE = "temperature_publisher.py"
Judge = Callable[[Unit], Outcome]


def report(status: Status = Status.PASSED, **others: Status) -> Report:
    """A report of i1.1 in which all criteria have this status, but for the `others` (sensor_name: sensor-name)."""
    given = {name.replace("_", "-"): other for name, other in others.items()}
    criteria = [
        CriterionResult(each.id, each.text, each.bonus, Verdict(given.get(each.id, status), observed="seen"), 1.0)
        for each in LESSON.criteria
    ]
    remarks = (Remark("an-id", "it will bite", FILE, 3),)
    exercise = ExerciseResult("i1.1", LESSON.title, (FILE,), tuple(criteria), 2.0, remarks=remarks)
    return Report(detect().for_report(), (exercise,), 2.0)


class MadeUp:
    """An executor that judges with a function, and keeps the keys of what it was asked for."""

    slots = 2

    def __init__(self, judge: Judge = lambda unit: Outcome(report(), 1.5)) -> None:
        self.judge = judge
        self.keys: list[str] = []

    async def run(self, unit: Unit, on_event: OnEvent) -> Outcome:
        self.keys.append(unit.key)
        return self.judge(unit)


class Silent:
    """A watcher that keeps what was finished."""

    def __init__(self) -> None:
        self.results: list[Result] = []

    def started(self, work: Work) -> None:
        pass

    def event(self, work: Work) -> OnEvent:
        return lambda event: None

    def finished(self, result: Result) -> None:
        self.results.append(result)


class School:
    """A class in a folder, with its results."""

    def __init__(self, root: Path) -> None:
        self.submissions, self.scratch = root / "class", root / "scratch"
        self.scratch.mkdir()
        self.folder = ResultFolder(root / "results")
        self.hand_in("ada")
        self.hand_in("bob")
        (self.submissions / "cyd").mkdir()

    def hand_in(self, name: str, source: str = "print()\n") -> None:
        path = self.submissions / name / FILE
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(source)

    async def grade(self, executor: MadeUp, *, again: bool = False) -> dict[str, Result]:
        grading = Grading(COURSE, self.folder)
        plan = grading.plan(find_work(self.submissions, COURSE, self.scratch), again=again)
        results = await grading.grade(plan, executor, Options(isolate=False), Silent())
        return {result.learner.id: result for result in results}


@pytest.fixture
def school(tmp_path: Path) -> School:
    return School(tmp_path)


async def test_a_second_start_checks_only_what_has_changed(school: School) -> None:
    first = MadeUp()
    statuses = {name: result.status for name, result in (await school.grade(first)).items()}
    assert statuses == {"ada": "passed", "bob": "passed", "cyd": "missing"}
    assert sorted(first.keys) == ["ada/i1.1", "bob/i1.1"]
    school.hand_in("bob", "print(2)\n")
    second = MadeUp()
    assert len(await school.grade(second)) == 3
    assert second.keys == ["bob/i1.1"]
    third = MadeUp()
    await school.grade(third, again=True)
    assert sorted(third.keys) == ["ada/i1.1", "bob/i1.1"]


async def test_a_fault_is_repeated_once_and_again_by_the_next_start(school: School) -> None:
    executor = MadeUp(lambda unit: Outcome(None, fault="no room") if unit.key.startswith("ada") else Outcome(report()))
    results = await school.grade(executor)
    assert executor.keys.count("ada/i1.1") == 2
    assert executor.keys[-1] == "ada/i1.1"
    assert (results["ada"].status, results["ada"].attempt) == ("error", 2)
    assert results["ada"].report.message == "no room"
    after = MadeUp()
    assert (await school.grade(after))["ada"].status == "passed"
    assert after.keys == ["ada/i1.1"]


async def test_files_that_change_while_a_class_is_graded_are_not_judged(school: School) -> None:
    def meddle(unit: Unit) -> Outcome:
        school.hand_in("bob", "print('not mine')\n")
        return Outcome(report())

    executor = MadeUp(meddle)
    executor.slots = 1
    bob = (await school.grade(executor))["bob"]
    assert bob.status == "error"
    assert "changed" in bob.report.message


async def test_a_result_is_read_back_whole_and_a_damaged_one_is_judged_again(school: School) -> None:
    result = (await school.grade(MadeUp()))["ada"]
    assert decode(encode(result)) == result
    school.folder.path_of(result.learner, "i1.1").write_text("{")
    executor = MadeUp()
    await school.grade(executor)
    assert executor.keys == ["ada/i1.1"]


def points_of(toml: str, tmp_path: Path) -> Points:
    file = tmp_path / "points.toml"
    file.write_text(toml)
    return Points.read(file, COURSE)


@pytest.mark.parametrize(
    ("toml", "expected"),
    [
        ("", (10 * 5 / 6, 10)),
        ("default = 6", (5, 6)),
        ("[i1.1]\npoints = 12\nbonus = 1", (11, 12)),
        ('["i1.1"]\npoints = 12', (10, 12)),
        ("[i1.1]\npoints = 10\n[i1.1.criteria]\nrate = 3\npublishes = 1\nshutdown = 0.5", (3.0, 10)),
    ],
)
async def test_points(toml: str, expected: tuple[float, float], school: School, tmp_path: Path) -> None:
    result = (await school.grade(MadeUp(lambda unit: Outcome(report(rate=Status.FAILED)))))["ada"]
    score = points_of(toml, tmp_path).score(result)
    assert score.score == pytest.approx(expected[0])
    assert score.max_score == expected[1]


async def test_a_fault_gives_no_points_and_no_zero(school: School) -> None:
    results = await school.grade(MadeUp(lambda unit: Outcome(report(rate=Status.ERROR))))
    assert results["ada"].status == "error"
    assert Points().score(results["ada"]).score is None
    assert Points().score(results["cyd"]).score == 0


@pytest.mark.parametrize("toml", ["[i9.9]\npoints = 1", "[i1.1]\npionts = 1", "[i1.1.criteria]\nrange = -1", "x ="])
def test_a_points_file_that_is_wrong_is_refused(toml: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"points\.toml"):
        points_of(toml, tmp_path)


async def test_table_and_csv(school: School) -> None:
    school.hand_in("=cmd|'x'!A0")
    results = await school.grade(MadeUp())
    gradebook = Gradebook.of(results.values(), COURSE, Points())
    table = text.render(gradebook, color=False, width=100)
    assert "ada" in table
    assert "10 of 10" in table
    rows = csv_table.render(gradebook).splitlines()
    assert rows[0].startswith("learner,name,")
    assert "ada,ada,,,i1.1,passed,10,10," in rows[2]
    assert rows[1].startswith("'=cmd")  # no formula for a spreadsheet
