"""Entries that say what a symptom is, where no mistake of the catalogue explains it: what to look at next, and how.

The criterion's own words come first (`Observation.says` and `.do`); an entry's are for criteria that have none.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from tutor.mistakes.entry import Case, Evidence, Found, mistake

symptom = partial(mistake, evidence=Evidence.SYMPTOM, says="{says}", do="{do}")


def in_words(case: Case, says: str, do: str) -> Iterator[Found]:
    """The criterion's own words, or else these."""
    yield Found({"says": case.seen.says or says, "do": case.seen.do or do})
