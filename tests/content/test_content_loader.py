"""Loading a course: what is read, and how errors are reported."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tutor.content import CriterionText, Difficulty, LessonFile, load_course, loader
from tutor.errors import ContentError, UnknownExercise


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert text.count(old) == 1, f"{old!r} is {text.count(old)} times in {file}"
    file.write_text(text.replace(old, new))


def copy_course(lesson_folder: Path, root: Path, folder: str, lesson_id: str) -> Path:
    """Write a second course, whose one lesson differs from the first only in its id. Return the lesson's folder."""
    copied = root / "lessons" / folder
    for kind in ("skeleton", "solution"):
        (copied / kind).mkdir(parents=True)
        (copied / kind / "mover.py").write_text((lesson_folder / kind / "mover.py").read_text())
    text = (lesson_folder / "lesson.md").read_text()
    (copied / "lesson.md").write_text(text.replace("id: x1.1", f"id: {lesson_id}"))
    return copied


def test_every_field_of_a_lesson_is_read(lesson_folder: Path) -> None:
    (lesson,) = load_course().lessons
    assert (lesson.id, lesson.title, lesson.unit) == ("x1.1", "First Steps", "X1: Beginnings")
    assert lesson.difficulty is Difficulty.EASY
    assert str(lesson.difficulty) == "easy"
    assert lesson.objective == "Make a node move."
    assert lesson.files == (
        LessonFile("mover.py", True, lesson_folder / "skeleton/mover.py", lesson_folder / "solution/mover.py"),
    )
    assert lesson.criteria == (
        CriterionText("moves", "It moves", bonus=False, open=True, hint="Move it."),
        CriterionText("stops", "It stops", bonus=True, open=False, hint="Stop it."),
    )
    assert lesson.hints == ("Think of moving.", "Call move.", "Call move(1.0).")
    assert lesson.checklist == ("move",)
    assert lesson.body.startswith("## Objective\n")
    assert lesson.body.endswith("Whether it moved.\n")
    assert lesson.folder == lesson_folder


def test_the_checklist_is_read(lesson_folder: Path) -> None:
    checklist = load_course().checklist
    assert [(group.id, group.title) for group in checklist.groups] == [("moving", "Moving")]
    assert [(item.id, item.text) for item in checklist.items] == [("move", "Make things move")]


def test_the_checks_folder_is_beside_the_lessons(lesson_folder: Path, tmp_path: Path) -> None:
    assert load_course().lessons[0].check == tmp_path / "checks" / "x1_1.py"


def test_windows_line_endings_are_read(lesson_folder: Path) -> None:
    file = lesson_folder / "lesson.md"
    file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))
    assert load_course().lessons[0].title == "First Steps"


def test_lessons_are_sorted_by_number(lesson_folder: Path) -> None:
    for folder in ("x1_10", "x10_1", "x2_1", "x1_2"):
        copy_course(lesson_folder, lesson_folder.parents[1], folder, folder.replace("_", "."))
    assert [lesson.id for lesson in load_course().lessons] == ["x1.1", "x1.2", "x1.10", "x2.1", "x10.1"]


def test_a_course_can_order_its_units_and_go_beyond_itself(lesson_folder: Path) -> None:
    for folder in ("b1_1", "b1_2", "a3_1", "y1_1"):
        copy_course(lesson_folder, lesson_folder.parents[1], folder, folder.replace("_", "."))
    units = lesson_folder.parent / "units.yaml"
    units.write_text("order: [y1, x1]\nbeyond: [b1]\n")
    lessons = load_course().lessons
    assert [lesson.id for lesson in lessons] == ["y1.1", "x1.1", "a3.1", "b1.1", "b1.2"]
    assert [lesson.id for lesson in lessons if lesson.beyond] == ["b1.1", "b1.2"]

    units.write_text("order: [x1, b1]\nbeyond: [b1]\n")
    with pytest.raises(ContentError, match="b1 is in `order` as well"):
        load_course()


@pytest.mark.parametrize("text", ["x1.1", "X1.1", "x1_1", "X1_1", " x1.1 "])
def test_a_lesson_is_found_however_its_id_is_written(lesson_folder: Path, text: str) -> None:
    assert load_course().find(text).id == "x1.1"


@pytest.mark.parametrize(("text", "meant"), [("i1.11", "i1.1"), ("i11", "i1.1"), ("1.3", "i1.3"), ("I2_2x", "i2.2")])
def test_an_unknown_exercise_suggests_the_nearest(text: str, meant: str) -> None:
    known = ["i1.1", "i1.3", "i2.2"]
    error = UnknownExercise(text, known)
    assert error.nearest == meant
    assert f"Did you mean {meant}?" in str(error)


def test_an_unknown_exercise_unlike_any_lists_the_known_ones(lesson_folder: Path) -> None:
    with pytest.raises(UnknownExercise) as caught:
        load_course().find("temperature")
    assert str(caught.value) == "There is no exercise 'temperature'. The exercises are: x1.1."


def test_another_course_comes_after_the_bundled_one(lesson_folder: Path, tmp_path: Path) -> None:
    extra = tmp_path / "extra"
    copied = copy_course(lesson_folder, extra, "a1_1", "a1.1")
    (extra / "lessons" / "checklist.yaml").write_text(
        "groups: [{id: more, title: More, items: [{id: jump, text: Make things jump}]}]"
    )
    course = load_course(extra)
    assert [lesson.id for lesson in course.lessons] == ["x1.1", "a1.1"]
    assert course.find("a1.1").check == extra / "checks" / "a1_1.py"
    assert course.find("a1.1").folder == copied
    assert [item.id for item in course.checklist.items] == ["move", "jump"]


def test_another_course_needs_no_checklist(lesson_folder: Path, tmp_path: Path) -> None:
    copy_course(lesson_folder, tmp_path / "extra", "a1_1", "a1.1")
    assert [item.id for item in load_course(tmp_path / "extra").checklist.items] == ["move"]


def test_an_id_of_two_courses_is_that_of_the_first_and_the_other_has_the_name_of_its_course(
    lesson_folder: Path, tmp_path: Path
) -> None:
    copied = copy_course(lesson_folder, tmp_path / "extra", "x1_1", "x1.1")
    copy_course(lesson_folder, tmp_path / "extra", "x1_2", "x1.2")
    course = load_course(tmp_path / "extra")
    assert [lesson.id for lesson in course.lessons] == ["x1.1", "extra:x1.1", "x1.2"]
    assert course.find("x1.1").folder == lesson_folder
    assert course.find("extra:X1_1").folder == copied
    assert course.find("extra:x1.2") is course.find("x1.2")
    assert course.headings == (loader.BUNDLED_TITLE, "extra")
    assert not course.knows("other:x1.1")


def test_only_leaves_out_the_bundled_course(lesson_folder: Path, tmp_path: Path) -> None:
    copy_course(lesson_folder, tmp_path / "extra", "x1_1", "x1.1")
    (lesson,) = load_course(tmp_path / "extra", only=True).lessons
    assert (lesson.id, lesson.course) == ("x1.1", "extra")


def test_two_courses_of_one_name_with_one_id_cannot_be_told_apart(lesson_folder: Path, tmp_path: Path) -> None:
    for name in ("one", "two"):
        copy_course(lesson_folder, tmp_path / name, "x1_1", "x1.1")
        (tmp_path / name / "course.yaml").write_text("format: 1\nname: same\n")
    with pytest.raises(ContentError, match="there is a course named same already"):
        load_course([tmp_path / "one", tmp_path / "two"])


def test_a_missing_course_is_reported(lesson_folder: Path, tmp_path: Path) -> None:
    with pytest.raises(ContentError, match="nowhere/lessons: there is no such folder"):
        load_course(tmp_path / "nowhere")


@pytest.mark.parametrize(
    ("old", "new", "line", "field", "message"),
    [
        ("title: First Steps\n", "", 2, "title", "this field is missing"),
        ("title: First Steps", "title:", 3, "title", "expected a text, found nothing"),
        ("title: First Steps", "title: 7", 3, "title", "expected a text, found a number"),
        ("id: x1.1", "id: x1.2", 2, "id", "'x1.2' does not belong in the folder x1_1"),
        ("difficulty: easy", "difficulty: hard", 4, "difficulty", "'hard' is not one of easy, medium, challenge"),
        ("objective:", "objektive:", 2, "objective", "this field is missing"),
        ("title: First Steps", "title: First Steps\nextra: 1", 4, "extra", "there is no such field"),
        ("mover.py", "../mover.py", 8, "files[1].name", "expected a file name, found '../mover.py'"),
        ("text: It stops", "text: [It, stops]", 14, "criteria[2].text", "expected a text, found a list"),
        ("hint: Stop it.", "tip: Stop it.", 13, "criteria[2].hint", "this field is missing"),
        ("bonus: true", "bonus: yep", 15, "criteria[2].bonus", "expected true or false, found a text"),
        ("- Call move.", "- 3", 20, "hints[2]", "expected a text, found a number"),
        ("checklist: [move]", "checklist: move", 22, "checklist", "expected a list, found a text"),
        ('unit: "X1', "unit: X1", 5, "", "not valid YAML: mapping values are not allowed in this context"),
    ],
)
def test_an_error_names_its_line_and_field(
    lesson_folder: Path, old: str, new: str, line: int, field: str, message: str
) -> None:
    file = lesson_folder / "lesson.md"
    edit(file, old, new)
    with pytest.raises(ContentError) as caught:
        load_course()
    error = caught.value
    assert (error.file, error.line, error.field, error.message) == (file, line, field, message)
    assert str(error) == f"{file}:{line}: {field}: {message}".replace(": : ", ": ")


def test_a_lesson_without_front_matter_is_refused(lesson_folder: Path) -> None:
    (lesson_folder / "lesson.md").write_text("## Objective\n")
    with pytest.raises(ContentError, match=r"lesson\.md:1: expected a front matter"):
        load_course()


def test_a_front_matter_that_does_not_end_is_refused(lesson_folder: Path) -> None:
    (lesson_folder / "lesson.md").write_text("---\nid: x1.1\n")
    with pytest.raises(ContentError, match=r"lesson\.md:1: expected a front matter"):
        load_course()


def test_a_front_matter_without_fields_is_refused(lesson_folder: Path) -> None:
    (lesson_folder / "lesson.md").write_text("---\njust words\n---\n")
    with pytest.raises(ContentError, match=r"lesson\.md:2: expected fields \(name: value\), found a text"):
        load_course()


def test_a_folder_without_a_lesson_is_refused(lesson_folder: Path) -> None:
    (lesson_folder / "lesson.md").unlink()
    with pytest.raises(ContentError, match=r"lesson\.md: cannot read it: No such file"):
        load_course()


def test_text_that_is_not_utf8_is_refused(lesson_folder: Path) -> None:
    (lesson_folder / "lesson.md").write_bytes(b"---\nid: \xff\n---\n")
    with pytest.raises(ContentError, match="not UTF-8"):
        load_course()


def test_an_error_in_the_checklist_names_its_line_and_field(lesson_folder: Path) -> None:
    file = lesson_folder.parent / "checklist.yaml"
    edit(file, "title: Moving", "titel: Moving")
    with pytest.raises(ContentError) as caught:
        load_course()
    assert (caught.value.file, caught.value.line, caught.value.field) == (file, 2, "groups[1].title")


def test_yaml_cannot_construct_python_objects(lesson_folder: Path) -> None:
    edit(lesson_folder / "lesson.md", "title: First Steps", "title: !!python/object/apply:os.getcwd []")
    with pytest.raises(ContentError, match="not valid YAML"):
        load_course()


def test_reading_the_course_imports_neither_ros_nor_textual() -> None:
    code = (
        "import sys; from tutor.content import load_course; load_course();"
        "print(sorted({name.partition('.')[0] for name in sys.modules} & {'rclpy', 'textual', 'rich', 'lessons'}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
