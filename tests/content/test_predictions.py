"""Predictions: how they are read, which option holds, and what the linter finds in them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.content.test_content_lint import find_problems
from tutor.content import Option, Prediction, load_course
from tutor.errors import ContentError

PREDICTIONS = """\
predictions:
  - id: two-wheels
    program: predict/wheels.py
    asks: How many wheels turn?
    options:
      - says: one
        seen: "turning: 1$"
      - says: two
        seen: "turning: 2$"
    because: Each has a motor.
    shows: [move]
"""


@pytest.fixture
def file(lesson_folder: Path) -> Path:
    (lesson_folder / "predict").mkdir()
    (lesson_folder / "predict/wheels.py").write_text("print('turning: 2')\n")
    file = lesson_folder / "predictions.yaml"
    file.write_text(PREDICTIONS)
    return file


def edit(file: Path, old: str, new: str) -> None:
    assert file.read_text().count(old) == 1
    file.write_text(file.read_text().replace(old, new))


def test_every_field_is_read_and_a_lesson_may_have_none(file: Path) -> None:
    (lesson,) = load_course().lessons
    assert lesson.predictions == (
        Prediction(
            "two-wheels",
            file.parent / "predict/wheels.py",
            "How many wheels turn?",
            (Option("one", "turning: 1$"), Option("two", "turning: 2$")),
            "Each has a motor.",
            ("move",),
        ),
    )
    file.unlink()
    assert load_course().lessons[0].predictions == ()


@pytest.mark.parametrize(
    ("old", "new", "line", "field", "text"),
    [
        ("asks: How many wheels turn?", "ask: How many?", 2, "predictions[1].asks", "this field is missing"),
        (
            '"turning: 1$"',
            '"turning: (1"',
            7,
            "predictions[1].options[1].seen",
            "'turning: (1' is no regular expression",
        ),
        (
            "predict/wheels.py",
            "../x1_2/wheels.py",
            3,
            "predictions[1].program",
            "expected a file of the lesson's folder",
        ),
        ("because: Each", "why: Each", 2, "predictions[1].because", "this field is missing"),
        ("shows: [move]", "shows: move", 11, "predictions[1].shows", "expected a list"),
        ("- id: two-wheels", "- id: [", 4, "", "not valid YAML"),
    ],
)
def test_an_error_names_file_line_and_field(file: Path, old: str, new: str, line: int, field: str, text: str) -> None:
    edit(file, old, new)
    with pytest.raises(ContentError) as raised:
        load_course()
    assert (raised.value.file, raised.value.field) == (file, field)
    assert raised.value.line == line
    assert raised.value.message.startswith(text)


@pytest.mark.parametrize(
    ("written", "holding"),
    [
        (["ready", "[INFO] [1.0] [cart]: turning: 2"], (1,)),
        (["turning: 1", "turning: 2"], (0, 1)),
        (["turning: 12"], (1,)),
        (["turning: 3"], ()),
        ([], ()),
    ],
)
def test_an_option_holds_if_a_line_has_its_pattern(file: Path, written: list[str], holding: tuple[int, ...]) -> None:
    edit(file, '"turning: 2$"', '"turning: \\\\d?2$"')
    assert load_course().lessons[0].predictions[0].holding(written) == holding


def test_good_predictions_are_no_problem_and_their_files_no_strays(file: Path) -> None:
    assert find_problems(file.parent) == []


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("id: two-wheels", "id: Two_Wheels", "the prediction Two_Wheels: its id is not in kebab-case"),
        ("says: two\n", "says: one\n", "the prediction two-wheels: the option 'one' appears twice"),
        ('"turning: 2$"', '"turning: 1$"', "the prediction two-wheels: two options hold when 'turning: 1$' is seen"),
        ("turn?", "turn.", "the prediction two-wheels: what it asks does not end with a question mark"),
        ("[move]", "[fly]", "the prediction two-wheels: the checklist has no item 'fly'"),
        ("[move]", "[move, move]", "the prediction two-wheels: the checklist item move is named twice"),
        (
            '      - says: two\n        seen: "turning: 2$"\n',
            "",
            "the prediction two-wheels: it has 1 options, not 2 to 4",
        ),
    ],
)
def test_a_problem_is_found(file: Path, old: str, new: str, text: str) -> None:
    edit(file, old, new)
    assert find_problems(file.parent) == [("x1_1/predictions.yaml", text)]


def test_problems_of_a_program_are_found(file: Path) -> None:
    program = file.parent / "predict/wheels.py"
    program.write_text(f"print({'1' * 80})\n")
    assert find_problems(file.parent) == [
        ("x1_1/predict/wheels.py", f"'print({'1' * 80})' is wider than 71 characters")
    ]
    program.write_text("print(\n")
    assert find_problems(file.parent)[0][1].startswith("it does not compile")
    program.unlink()
    assert find_problems(file.parent) == [("x1_1/predict/wheels.py", "this file is missing")]
    (file.parent / "predict/other.py").write_text("")
    assert ("x1_1/predict/other.py", "this file belongs to no lesson") in find_problems(file.parent)


def test_an_id_is_used_once(file: Path) -> None:
    again = PREDICTIONS.partition("\n")[2]
    file.write_text(PREDICTIONS + again)
    assert ("x1_1/predictions.yaml", "the prediction two-wheels appears twice") in find_problems(file.parent)
