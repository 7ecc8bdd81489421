"""Looks up mistakes in the catalogue, which is loaded only then, for the front ends to show their pages."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from tutor.content import Course, Lesson

if TYPE_CHECKING:
    from tutor.mistakes import Mistake

CHECKS_IN_A_ROW = 3
"""After this many checks in a row that failed by the same mistake, its page is offered unasked."""


def find_mistakes(ids: Iterable[str], course: Course, lesson: Lesson) -> list[Mistake]:
    """Return those of these mistakes that are known: the lesson's own, or else ours.

    The first call loads the catalogue, which takes some tenths of a second. Raises EngineError if a course's catalogue
    cannot be loaded.
    """
    from tutor.engine.loading import load_catalogues
    from tutor.mistakes import pages

    known = pages.every_mistake(load_catalogues(replace(course, lessons=(lesson,))))
    return [known[id] for id in dict.fromkeys(ids) if id in known]
