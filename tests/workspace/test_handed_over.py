"""A system that is handed over: the fault that is drawn, kept, exchanged, and answered."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tutor.content import Lesson, load_course
from tutor.content.cases import Cases, cases_of, read_report
from tutor.errors import UsageError, WorkspaceError
from tutor.workspace import Workspace, start, start_another, start_in
from tutor.workspace.answering import answer, ask
from tutor.workspace.drawn_cases import WHOLE, Drawn, skeleton_text, solution_text


@pytest.fixture(scope="module")
def courier() -> Lesson:
    return load_course().find("b1.7")


@pytest.fixture(scope="module")
def cases(courier: Lesson) -> Cases:
    found = cases_of(courier)
    assert found is not None
    return found


def broken_files(lesson: Lesson, workspace: Workspace) -> list[str]:
    return [
        file.name
        for file in lesson.files
        if file.name != "courier_report.yaml"
        and workspace.path_of(file.name).read_text() != file.solution.read_text(encoding="utf-8")
    ]


def report_of(workspace: Workspace) -> Path:
    return workspace.path_of("courier_report.yaml")


def test_a_lesson_without_cases_draws_none(workspace: Workspace) -> None:
    lesson = load_course().find("i1.1")
    start(lesson, workspace)
    assert cases_of(lesson) is None
    assert workspace.cases().read("i1.1") == Drawn()
    with pytest.raises(WorkspaceError, match="only one"):
        start_another(lesson, workspace)
    with pytest.raises(UsageError, match="nothing to answer"):
        ask(lesson, workspace)


def test_every_case_can_be_put_in_and_answered(courier: Lesson, cases: Cases) -> None:
    assert len(cases.cases) >= 8
    for case in cases.cases:
        drawn = Drawn((case.id,))
        changed = [
            file.name
            for file in courier.files
            if skeleton_text(courier, file, drawn) != file.solution.read_text(encoding="utf-8")
        ]
        assert changed == [case.where, "courier_report.yaml"]
        report = next(file for file in courier.files if file.name == "courier_report.yaml")
        assert read_report(skeleton_text(courier, report, drawn)).case == case.id
        solved = read_report(solution_text(courier, report, drawn))
        assert (solved.case, solved.what, solved.where) == (case.id, case.what[0], case.where)


def test_nothing_in_a_report_tells_the_fault(courier: Lesson, cases: Cases) -> None:
    report = next(file for file in courier.files if file.name == "courier_report.yaml")
    texts = {skeleton_text(courier, report, Drawn((case.id,))).replace(case.id, "") for case in cases.cases}
    assert len(texts) == 1


def test_a_start_draws_one_and_a_second_start_keeps_it(courier: Lesson, cases: Cases, workspace: Workspace) -> None:
    start(courier, workspace)
    drawn = workspace.cases().read("b1.7").current
    case = cases.find(drawn)
    assert case is not None
    assert broken_files(courier, workspace) == [case.where]
    assert read_report(report_of(workspace).read_text()).case == drawn
    workspace.path_of("courier_driver.py").unlink()
    start(courier, workspace)
    start(courier, workspace, force=True)
    assert workspace.cases().read("b1.7").cases == (drawn,)


def test_another_one_moves_all_files_away_so_that_no_difference_shows(courier: Lesson, workspace: Workspace) -> None:
    start(courier, workspace)
    first = workspace.cases().read("b1.7").current
    started = start_another(courier, workspace)
    drawn = workspace.cases().read("b1.7")
    assert drawn.cases[0] == first != drawn.current
    assert {path.name for path in started.files.written} == {file.name for file in courier.files}
    (kept,) = started.files.backups
    assert {path.name for path in kept.iterdir()} == {file.name for file in courier.files}
    assert read_report((kept / "courier_report.yaml").read_text()).case == first
    assert not list(workspace.package.rglob("*~"))


def test_all_are_drawn_before_one_comes_again(cases: Cases) -> None:
    drawn = Drawn()
    for _ in cases.cases:
        drawn = drawn.draw(cases)
    assert sorted(drawn.cases) == sorted(case.id for case in cases.cases)
    left = drawn.cases[3]
    drawn = replace(drawn, repaired=tuple(id for id in drawn.cases if id != left))
    assert drawn.draw(cases).current == left
    assert replace(drawn, repaired=drawn.cases).draw(cases).current != drawn.current


def test_what_is_repaired_is_counted_once(courier: Lesson, workspace: Workspace) -> None:
    start(courier, workspace)
    assert workspace.cases().read("b1.7").describe() == ""
    workspace.cases().repaired("b1.7")
    workspace.cases().repaired("b1.7")
    assert workspace.cases().read("b1.7").describe() == f"1 of {WHOLE} faults found and repaired"
    workspace.cases().repaired("i1.1")
    assert workspace.cases().read("i1.1") == Drawn()


def test_a_folder_keeps_the_case_that_its_report_names(courier: Lesson, tmp_path: Path) -> None:
    start_in(courier, tmp_path)
    drawn = read_report((tmp_path / "courier_report.yaml").read_text()).case
    (tmp_path / "courier_driver.py").unlink()
    started = start_in(courier, tmp_path)
    assert started.files.written == (tmp_path / "courier_driver.py",)
    assert read_report((tmp_path / "courier_report.yaml").read_text()).case == drawn


def test_an_answer_is_written_and_counted(courier: Lesson, workspace: Workspace) -> None:
    start(courier, workspace)
    comment = report_of(workspace).read_text().splitlines()[0]
    drawn = workspace.cases().read("b1.7").current
    assert answer(courier, workspace, "rate", "courier_driver.py").tries == 1
    assert answer(courier, workspace, "rate", "courier_driver.py").tries == 1
    report = answer(courier, workspace, "timer", "courier_driver.py")
    assert (report.case, report.what, report.where, report.tries) == (drawn, "timer", "courier_driver.py", 2)
    assert report_of(workspace).read_text().startswith(comment)
    assert ask(courier, workspace).report == report


@pytest.mark.parametrize("left", ["", "what: ???: :\n", "case:\nwhat:\n", "tries: 7\n"])
def test_an_answer_repairs_a_report_that_was_damaged(courier: Lesson, workspace: Workspace, left: str) -> None:
    start(courier, workspace)
    report_of(workspace).write_text(left)
    report = answer(courier, workspace, "qos", "courier_monitor.py")
    assert (report.case, report.what) == (workspace.cases().read("b1.7").current, "qos")


def test_an_answer_that_is_no_choice_is_refused(courier: Lesson, workspace: Workspace) -> None:
    with pytest.raises(UsageError, match="not started"):
        answer(courier, workspace, "qos", "courier_monitor.py")
    start(courier, workspace)
    for what, where in (("magic", "courier_driver.py"), ("qos", "driver")):
        with pytest.raises(UsageError, match="none of the choices"):
            answer(courier, workspace, what, where)


def test_a_damaged_record_is_set_aside_with_a_word(courier: Lesson, workspace: Workspace) -> None:
    start(courier, workspace)
    said: list[str] = []
    path = workspace.cases().path
    path.write_text("{")
    assert workspace.cases(said.append).read("b1.7") == Drawn()
    assert "faults were drawn" in said[0]
