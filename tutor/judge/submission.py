"""A learner's answer to one exercise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Submission:
    """The files of one submission: the exercise's own file name, and where the learner's file is.

    An optional file that is missing is absent from `files`. Files are run where they are, never copied, so that
    tracebacks show the learner's own paths and other files beside them are found.
    """

    exercise: str
    files: Mapping[str, Path]
