"""What the entries say in a report: short, one sentence to do, and in words. Placeholders as in the pages' examples."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from statistics import median

import pytest

from tests.mistakes.cases import all_catalogues, case_of
from tests.mistakes.limits import MAX_WORDS, MEDIAN_WORDS, code_in, faults_of, sentences_in, words_of
from tests.mistakes.test_exceptions import TABLES
from tutor.mistakes import Case, Catalogue, Mistake
from tutor.mistakes.diagnosis import Diagnosis, describe
from tutor.mistakes.exceptions import add, from_example


def told_by_entries() -> Iterator[tuple[str, Mistake, Diagnosis]]:
    """What each entry says of its bad examples, and each known exception of the examples of all its ways."""
    for where, catalogue in all_catalogues():
        for entry in catalogue.entries.values():
            for bad, _ in entry.examples:
                case = case_of(entry, bad)
                for found in entry.find(case):
                    yield f"{where}:{entry.id}", entry, describe(entry, found, case)
                    break
    for table in TABLES.values():
        for known in table:
            for way in known.ways:
                alone = Catalogue()
                add(alone, replace(known, ways=(way,)))
                entry = alone.entries[known.id]
                for example in way.examples:
                    case = Case(from_example(example)(""))
                    for found in entry.find(case):
                        yield f"exceptions:{known.id}", entry, describe(entry, found, case)
                        break


TOLD = list(told_by_entries())


@pytest.mark.parametrize(("entry", "told"), [told[1:] for told in TOLD], ids=[told[0] for told in TOLD])
def test_an_entry_is_short_and_in_words(entry: Mistake, told: Diagnosis) -> None:
    assert words_of(told.cause, told.step) <= MAX_WORDS, f"{told.cause}\n{told.step}"
    assert sentences_in(told.step) == 1, told.step
    assert not list(faults_of(told.step, slip=entry.slip)), told.step


def test_most_entries_are_shorter() -> None:
    assert median(words_of(told.cause, told.step) for _, _, told in TOLD) <= MEDIAN_WORDS


@pytest.mark.parametrize(
    ("step", "pieces"),
    [
        ("Cancel the old timer before you make the new one.", 0),
        ("Call super().__init__ as the first thing in __init__.", 0),
        ("Await call_async() in an async callback (as in main).", 0),
        ("Check the spelling of package=, and that the package is there (ros2 pkg list).", 0),
        ("Write self.create_timer(1.0 / rate, self.tick) there.", 1),
        ("Let it be rate = 5 there.", 1),
        ("self.a = 5\nself.b(7)", 2),
    ],
)
def test_code_is_told_from_words(step: str, pieces: int) -> None:
    assert len(code_in(step)) == pieces
