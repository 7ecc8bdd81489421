"""A mistake's page is its test: found in the bad example, not in the good one, and written as all pages are."""

from __future__ import annotations

import re
from collections import Counter

import pytest

from tests.mistakes.cases import all_catalogues, case_of
from tutor.mistakes import Evidence, Mistake
from tutor.mistakes.diagnosis import describe

MISTAKES = {f"{where}:{entry.id}": entry for where, found in all_catalogues() for entry in found.entries.values()}


@pytest.fixture(params=MISTAKES.values(), ids=list(MISTAKES))
def entry(request: pytest.FixtureRequest) -> Mistake:
    mistake: Mistake = request.param
    return mistake


def test_its_page_has_a_title_a_bad_and_a_good_example_and_a_way_to_see_it(entry: Mistake) -> None:
    assert entry.summary.endswith("."), "its page begins with a sentence"
    assert entry.examples, "there are blocks Bad: and Good:, indented by four spaces"
    assert "\nSee it: " in entry.page
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", entry.id)


def test_no_two_mistakes_have_one_id() -> None:
    """Also in different catalogues: `ros-tutor explain` shows one page for an id."""
    ids = Counter(entry.id for _, catalogue in all_catalogues() for entry in catalogue.entries.values())
    assert not [id for id, count in ids.items() if count > 1]


def test_it_is_found_in_its_bad_example_and_says_so(entry: Mistake) -> None:
    for bad, _ in entry.examples:
        case = case_of(entry, bad)
        found = next(iter(entry.find(case)), None)
        assert found is not None, f"not found in:\n{bad}"
        told = describe(entry, found, case)
        assert told.step.endswith((".", "?", ")", "'", '"')) or entry.slip


def test_it_is_not_found_in_its_good_example(entry: Mistake) -> None:
    if entry.evidence is not Evidence.SOURCE or entry.example is not None:
        pytest.skip("it is shown by a run")
    for _, good in entry.examples:
        assert next(iter(entry.find(case_of(entry, good))), None) is None, f"found in:\n{good}"
