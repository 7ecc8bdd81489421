"""The folder of results of a class: RESULTS/LEARNER/EXERCISE.json is the queue, the memory and the protocol."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from msgspec import to_builtins

from tutor.errors import StorageError
from tutor.grade.learners import Learner, safe_name
from tutor.json_codec import convert_to, read_document
from tutor.judge.result import ExerciseResult, Report
from tutor.judge.verdict import Status
from tutor.report import json_report
from tutor.workspace.atomic import write_atomically

SCHEMA = "ros-tutor/result/1"


@dataclass(frozen=True, slots=True)
class Version:
    """What a result depends on besides the submission: the digests of its lesson and check, and our version."""

    course: str
    ros_tutor: str


@dataclass(frozen=True, slots=True)
class Result:
    """One learner's result for one exercise. `graded_at` is UTC, ISO 8601. `digest`: see `Work`.

    `report` holds this one exercise. `cpu_s`: the CPU time of the check, in seconds, with all its processes. `attempt`
    counts from 1: a check that could not be judged is repeated.
    """

    learner: Learner
    exercise: str
    graded_at: str
    digest: str
    version: Version
    report: Report
    cpu_s: float = 0.0
    attempt: int = 1

    @property
    def judged(self) -> ExerciseResult | None:
        """The judged exercise; None if a fault kept the check from starting."""
        return self.report.exercises[0] if self.report.exercises else None

    @property
    def unjudged(self) -> bool:
        """Whether a fault left any criterion without a verdict, be it a bonus."""
        if self.status == "missing":
            return False
        criteria = self.judged.criteria if self.judged is not None else ()
        return not criteria or any(criterion.verdict.status is Status.ERROR for criterion in criteria)

    @property
    def status(self) -> str:
        """`passed`, `failed`, `missing` (nothing to judge), or `error` (a fault of the tool or the machine)."""
        judged = self.judged
        if judged is None:
            return "error"
        if judged.missing:
            return "missing"
        required = [criterion.verdict.status for criterion in judged.criteria if not criterion.bonus]
        if Status.ERROR in required:  # although others failed: the points for this one are not known
            return "error"
        return judged.verdict.value


class ResultFolder:
    """The results below one folder."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def path_of(self, learner: Learner, exercise: str) -> Path:
        """Return where the result of a learner's exercise belongs."""
        return self.root / learner.id / f"{exercise}.json"

    def save(self, result: Result) -> None:
        """Write a result, whole or not at all. Raises StorageError."""
        path = self.path_of(result.learner, result.exercise)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StorageError.of(f"create {path.parent}", error) from error
        try:
            write_atomically(path, encode(result))
        except StorageError as error:
            if not isinstance(error.__cause__, FileNotFoundError):
                raise
            write_atomically(path, encode(result))  # another machine has just swept this folder

    def read(self, learner: Learner, exercise: str) -> Result | None:
        """Return the result of a learner's exercise; None if there is none, or it cannot be understood."""
        result = _read(self.path_of(learner, exercise))
        return result if result is not None and result.exercise == exercise else None

    def __iter__(self) -> Iterator[Result]:
        """Yield every result, by learner and exercise."""
        for path in sorted(self.root.glob("*/*.json")):
            result = None if path.name.startswith(".") else _read(path)
            if result is not None and self.path_of(result.learner, result.exercise) == path:
                yield result

    def sweep(self) -> None:
        """Remove files that a killed process had not finished writing. Raises StorageError."""
        for pattern in (".*.tmp", "*/.*.tmp"):
            for path in self.root.glob(pattern):
                try:
                    path.unlink(missing_ok=True)
                except OSError as error:
                    raise StorageError.of(f"remove {path}", error) from error


def _read(path: Path) -> Result | None:
    try:
        return decode(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def encode(result: Result) -> str:
    """Return the document of a result (`ros-tutor/result/1`)."""
    learner = result.learner
    document = {
        "schema": SCHEMA,
        "learner": {
            "id": learner.id,
            "name": learner.name,
            "number": learner.number,
            "email": learner.email,
            "columns": dict(learner.columns),
        },
        "exercise": result.exercise,
        "status": result.status,
        "graded_at": result.graded_at,
        "digest": result.digest,
        "course": result.version.course,
        "ros_tutor": result.version.ros_tutor,
        "cpu_s": round(result.cpu_s, 2),
        "attempt": result.attempt,
        "report": json.loads(json_report.render(result.report)),
    }
    return json.dumps(document, ensure_ascii=False, indent=1) + "\n"


def decode(text: str) -> Result:
    """Read the document of a result, which may come from another machine. Raises ValueError."""
    document = read_document(text, SCHEMA)
    try:
        result = Result(
            learner=Learner(**document["learner"]),
            exercise=document["exercise"],
            graded_at=document["graded_at"],
            digest=document["digest"],
            version=Version(document["course"], document["ros_tutor"]),
            report=json_report.parse(document["report"]),
            cpu_s=document["cpu_s"],
            attempt=document["attempt"],
        )
    except (AttributeError, KeyError, TypeError) as error:
        raise ValueError("it is damaged") from error
    convert_to(Result, to_builtins(result))  # are all values of the right type?
    exercises = [exercise.id for exercise in result.report.exercises]
    if result.learner.id != safe_name(result.learner.id) or exercises not in ([], [result.exercise]):
        raise ValueError("it is damaged")
    judged = result.judged
    criteria = judged.criteria if judged is not None else ()
    seconds = (result.cpu_s, result.report.duration_s, *(criterion.duration_s for criterion in criteria))
    if not all(map(math.isfinite, seconds)):
        raise ValueError("it is damaged")
    return result
