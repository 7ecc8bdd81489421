"""A learner's answer to one exercise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Submission:
    """The files of one submission: from the file name that the exercise uses to the path of the learner's file.

    A missing optional file is absent from `files`. Files run in place, never as copies, so that tracebacks show the
    learner's own paths and local imports work.
    """

    exercise: str
    files: Mapping[str, Path]
