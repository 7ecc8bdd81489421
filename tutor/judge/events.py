"""The stream of events of a check, which the terminal app and the command line both consume.

Events cross a process border as JSON, one to a line (`encode`, `decode`), so that a front end need not share a process
with ROS.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import get_args

from tutor.json_codec import LineCodec
from tutor.judge.result import CriterionResult, ExerciseResult, Report


@dataclass(frozen=True, slots=True)
class CheckStarted:
    """A check of one exercise begins; `criteria` are the ids that will be judged, in the order to show them."""

    exercise: str
    criteria: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Progress:
    """How far one criterion is (`fraction`, 0 to 1), and what is being done to the node right now.

    `so_far`: what is known of the node by now, while the criterion still waits; not final, and often empty.
    """

    exercise: str
    criterion: str
    fraction: float
    doing: str
    so_far: str = ""


@dataclass(frozen=True, slots=True)
class CriterionJudged:
    """One criterion has its verdict."""

    exercise: str
    result: CriterionResult


@dataclass(frozen=True, slots=True)
class ExerciseJudged:
    """Every criterion of one exercise has its verdict."""

    result: ExerciseResult


@dataclass(frozen=True, slots=True)
class CheckFinished:
    """The last event of a check."""

    report: Report


Event = CheckStarted | Progress | CriterionJudged | ExerciseJudged | CheckFinished

_CODEC: LineCodec[Event] = LineCodec("event", get_args(Event))

encode = _CODEC.encode
decode = _CODEC.decode
