"""The event stream of a check, consumed by both the terminal app and the command line.

Events cross process boundaries as JSON lines (`encode`, `decode`), so that a front end need not share a process with
ROS.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import get_args

from tutor.json_codec import LineCodec
from tutor.judge.result import CriterionResult, ExerciseResult, Report

WAITING = "waiting for other checks on this machine"
"""What the progress of a check says while it waits for its turn."""


@dataclass(frozen=True, slots=True)
class CheckStarted:
    """The check of one exercise begins; `criteria` are the ids to be judged, in display order."""

    exercise: str
    criteria: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Progress:
    """How far one criterion is (`fraction`, 0 to 1), and what is being done to the node right now.

    `so_far`: preliminary findings while the criterion is still pending; often empty.
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


@dataclass(frozen=True, slots=True)
class ResourcesUsed:
    """What a check has used, told on request: `cpu_s` is the CPU time of all its processes, in seconds."""

    cpu_s: float


Event = CheckStarted | Progress | CriterionJudged | ExerciseJudged | CheckFinished | ResourcesUsed

_CODEC: LineCodec[Event] = LineCodec("event", get_args(Event))

encode = _CODEC.encode
decode = _CODEC.decode
