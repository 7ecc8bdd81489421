"""The linter: silent on a correct course, and one plain sentence for each problem."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tutor.content import Checklist, Course, load_course
from tutor.content.lint import lint_course


def find_problems(folder: Path) -> list[tuple[str, str]]:
    """Return the linter's problems as (file, text), the file relative to the folder of all lessons."""
    return [(str(problem.file.relative_to(folder.parent)), problem.text) for problem in lint_course(load_course())]


def test_a_correct_course_has_no_problems(lesson_folder: Path) -> None:
    assert find_problems(lesson_folder) == []


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("  - Call move.\n", "", "it has 2 hints instead of 3"),
        ("- Call move.\n", "- Think of moving.\n", "the hint 'Think of moving.' appears twice"),
        ("- id: moves", "- id: Moves_1", "the criterion id 'Moves_1' may only have lowercase letters and hyphens"),
        ("- id: stops", "- id: moves", "the criterion moves appears twice"),
        ("text: It moves\n", "text: It moves\n    bonus: true\n", "it has no criterion that is required"),
        (
            "text: It moves\n",
            "text: It moves\n    open: false\n",
            "the skeleton leaves no required criterion open: there is nothing to do",
        ),
        ("checklist: [move]", "checklist: [fly]", "the checklist has no item 'fly'"),
        ("checklist: [move]", "checklist: [move, move]", "the checklist item move is named twice"),
        (
            "text: It moves\n",
            "text: It moves\n    shows: [move, fly]\n",
            "the criterion moves shows 'fly', which is not in the lesson's checklist",
        ),
        ("- name: mover.py\n", "- name: mover.py\n    required: false\n", "it requires no file"),
        ("- name: mover.py\n", "- name: mover.py\n  - name: mover.py\n", "the file mover.py is named twice"),
        ("Make it move.", "Make\tit move.", "there is a tab in 'Make\\tit move.'"),
        (
            "## Objective",
            "# Objective\n\n## Objective",
            "the heading '# Objective' is a title: the title is in the front matter",
        ),
        ("```python", "```", "a code block does not say its language"),
        ("move(0.5)", "move(" + 75 * "1" + ")", f"the code 'move({75 * '1'})' is wider than 76 characters"),
        ("None.", "None.<br>", "there is raw HTML in 'None.<br>', which a terminal cannot show"),
        ("None.", "None `or\nso`.", "the code in 'None `or' is broken over two lines"),
        (
            "## Tasks\n",
            "## Things\n",
            "its sections are Objective, Background, Things, Commands to try, Pitfalls on Jazzy, What the checks "
            "look at; expected Objective, Background, Tasks, Commands to try, Pitfalls on Jazzy, What the checks "
            "look at",
        ),
    ],
)
def test_a_problem_in_the_lesson_is_found(lesson_folder: Path, old: str, new: str, text: str) -> None:
    file = lesson_folder / "lesson.md"
    assert file.read_text().count(old) == 1
    file.write_text(file.read_text().replace(old, new))
    assert ("x1_1/lesson.md", text) in find_problems(lesson_folder)


def test_bonus_criteria_come_last(lesson_folder: Path) -> None:
    course = load_course()
    swapped = replace(course.lessons[0], criteria=course.lessons[0].criteria[::-1])
    found = [problem.text for problem in lint_course(replace(course, lessons=(swapped,)))]
    assert found == ["its required criteria belong before the bonus ones"]


def test_a_code_block_that_never_closes_is_found(lesson_folder: Path) -> None:
    with (lesson_folder / "lesson.md").open("a") as file:
        file.write("```python\n")
    assert find_problems(lesson_folder) == [("x1_1/lesson.md", "a code block is never closed")]


def test_html_and_titles_in_code_are_allowed(lesson_folder: Path) -> None:
    with (lesson_folder / "lesson.md").open("a") as file:
        file.write("Use `<name>`.\n\n```text\n# <b>\n```\n")
    assert find_problems(lesson_folder) == []


@pytest.mark.parametrize("kind", ["skeleton", "solution"])
def test_a_missing_file_is_found(lesson_folder: Path, kind: str) -> None:
    (lesson_folder / kind / "mover.py").unlink()
    assert find_problems(lesson_folder) == [(f"x1_1/{kind}/mover.py", "this file is missing")]


@pytest.mark.parametrize("kind", ["skeleton", "solution"])
def test_a_file_that_does_not_compile_is_found(lesson_folder: Path, kind: str) -> None:
    (lesson_folder / kind / "mover.py").write_text("def move(:\n")
    ((file, text),) = find_problems(lesson_folder)
    assert file == f"x1_1/{kind}/mover.py"
    assert text.startswith("it does not compile: ")
    assert "line 1" in text


def test_a_tab_in_code_is_found(lesson_folder: Path) -> None:
    (lesson_folder / "solution" / "mover.py").write_text("if True:\n\tpass\n")
    assert find_problems(lesson_folder) == [("x1_1/solution/mover.py", "there is a tab in it")]


def test_a_skeleton_that_is_the_solution_is_found(lesson_folder: Path) -> None:
    (lesson_folder / "skeleton" / "mover.py").write_bytes((lesson_folder / "solution" / "mover.py").read_bytes())
    assert find_problems(lesson_folder) == [("x1_1/skeleton/mover.py", "the skeleton is the solution")]


def test_a_stray_file_is_found_and_bytecode_is_not(lesson_folder: Path) -> None:
    (lesson_folder / "notes.txt").touch()
    (lesson_folder / "solution" / "helper.py").touch()
    (lesson_folder / "solution" / "__pycache__").mkdir()
    (lesson_folder / "solution" / "__pycache__" / "mover.cpython-312.pyc").touch()
    assert find_problems(lesson_folder) == [
        ("x1_1/notes.txt", "this file belongs to no lesson"),
        ("x1_1/solution/helper.py", "this file belongs to no lesson"),
    ]


def test_an_exercise_id_used_twice_is_found(lesson_folder: Path) -> None:
    course = load_course()
    twice = replace(course, lessons=course.lessons * 2)
    assert "the exercise id x1.1 is used twice" in [problem.text for problem in lint_course(twice)]


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("id: moving", "id: move", "the id move is used twice"),
        ("id: moving", "id: Moving things", "the id 'Moving things' is not in kebab-case"),
        (
            "text: Make things move",
            "text: Make things move\n  - {id: rest, title: Rest, items: []}",
            "the group rest has no items",
        ),
    ],
)
def test_a_problem_in_the_checklist_is_found(lesson_folder: Path, old: str, new: str, text: str) -> None:
    file = lesson_folder.parent / "checklist.yaml"
    file.write_text(file.read_text().replace(old, new))
    assert ("checklist.yaml", text) in find_problems(lesson_folder)


def test_a_problem_is_one_line_with_its_file(lesson_folder: Path) -> None:
    (lesson_folder / "notes.txt").touch()
    (problem,) = lint_course(load_course())
    assert str(problem) == f"{lesson_folder}/notes.txt: this file belongs to no lesson"


def test_an_empty_course_has_no_problems() -> None:
    assert lint_course(Course((), Checklist())) == []
