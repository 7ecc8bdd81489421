"""How many exercises are passed, in numbers and in words. Those beyond the course are counted apart."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Protocol


class Counted(Protocol):
    """An exercise, in whatever form."""

    @property
    def id(self) -> str:
        """Its id."""

    @property
    def beyond(self) -> bool:
        """Whether it goes beyond the course."""


@dataclass(frozen=True, slots=True)
class Counts:
    """Of the course, `passed` of `total` exercises are passed; of those beyond it, `passed_beyond` of `beyond`."""

    passed: int
    total: int
    passed_beyond: int = 0
    beyond: int = 0

    @classmethod
    def of(cls, exercises: Iterable[Counted], passed: Collection[str]) -> Counts:
        """Count the exercises, and those whose ids are in `passed`. If all go beyond a course, they are the course."""
        every = tuple(exercises)
        course = [exercise for exercise in every if not exercise.beyond]
        beyond = [exercise for exercise in every if exercise.beyond]
        if not course:
            course, beyond = beyond, []
        return cls(_count(course, passed), len(course), _count(beyond, passed), len(beyond))

    @property
    def course_done(self) -> bool:
        """Whether all of the course is passed."""
        return self.passed == self.total

    @property
    def all_done(self) -> bool:
        """Whether everything is passed."""
        return self.course_done and self.passed_beyond == self.beyond

    def __str__(self) -> str:
        """As in "5 of 6 passed"; what goes beyond them is named once it matters."""
        return self.text()

    def text(self, noun: str = "") -> str:
        """Return the same, as in "5 of 6 exercises passed" with the noun "exercises"."""
        text = " ".join(word for word in (f"{self.passed} of {self.total}", noun, "passed") if word)
        if self.beyond and (self.course_done or self.passed_beyond):
            text += f", {self.passed_beyond} of {self.beyond} beyond"
        return text


def _count(exercises: Iterable[Counted], passed: Collection[str]) -> int:
    return sum(exercise.id in passed for exercise in exercises)
