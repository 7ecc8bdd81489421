"""`grade --format csv`: a table that spreadsheets show as it is."""

from __future__ import annotations

import csv
from io import StringIO

import pytest

from tests.grade import made
from tutor.grade.formats import render
from tutor.grade.formats.csv_table import as_text, number


def test_a_line_for_each_result() -> None:
    rows = list(csv.DictReader(StringIO(render(made.gradebook(), "csv"), newline="")))
    by_key = {(row["learner"], row["exercise"]): row for row in rows}
    assert len(by_key) == len(rows) == len(made.whole_class())
    assert by_key["brian", "i1.1"]["score"] == "1.67"
    assert by_key["ada", "i2.1"]["score"] == by_key["ada", "i2.1"]["max_score"] == "10"
    assert (by_key["chloe", "i1.1"]["status"], by_key["chloe", "i1.1"]["score"]) == ("missing", "0")
    assert by_key["neil", "i1.1"]["name"] == 'O\'Neil, "Jo"\nZoë; \\u202egnp.exe'


def test_what_a_fault_left_unjudged_has_neither_score_nor_failure() -> None:
    rows = csv.DictReader(StringIO(render(made.gradebook(), "csv"), newline=""))
    (row,) = [row for row in rows if (row["learner"], row["exercise"]) == ("chloe", "i2.1")]
    assert (row["status"], row["score"], row["failed"]) == ("error", "", "")


def test_no_cell_is_a_formula_or_has_control_characters() -> None:
    for row in csv.reader(StringIO(render(made.gradebook(), "csv"), newline="")):
        for cell in row:
            assert not cell.startswith(("=", "+", "-", "@"))
            assert all(character.isprintable() or character == "\n" for character in cell)


@pytest.mark.parametrize("cell", ["=1", " =1", "\n=1", "\t=1", "+1", "-1", "@x", "\uff1d1"])
def test_formulas_become_text(cell: str) -> None:
    assert as_text(cell).startswith("'")


def test_points_as_people_write_them() -> None:
    assert [number(value) for value in (0.0, 10.0, 100.0, 1.5, 5 / 3)] == ["0", "10", "100", "1.5", "1.67"]
