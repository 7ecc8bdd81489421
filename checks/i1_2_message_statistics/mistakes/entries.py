"""I1.2: entries for what the judges have seen, by the name that they give a fault (see `Fault`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Catalogue, Evidence, Found
from tutor.mistakes.entry import Find
from tutor.mistakes.examples import in_run

CATALOGUE = Catalogue()


def shown(
    id: str, *, says: str, do: str, name: str = "", symptom: Symptom = Symptom.WRONG_LOG, **words: Any
) -> Callable[[Find], Find]:
    """Register a fault that the judges name; `words`: an example of what they say of it."""
    return CATALOGUE.mistake(
        id,
        explains=[symptom],
        evidence=Evidence.SYMPTOM,
        says=says,
        do=do,
        name=name,
        example=in_run(symptom, fault=id, **words),
    )


def told(case: Case, fault: str) -> Iterator[Found]:
    """The fault with the judge's words, if it is this one."""
    if case.about("fault") == fault:
        yield Found(dict(case.seen.about))
