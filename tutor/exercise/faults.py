"""The faults that an exercise may hand over, each a case: what is wrong, and where.

They are content, in a file of the lesson's folder from which `ros-tutor start` draws one (`tutor.content.cases` reads
how each is put in, and checks the file):

    report: lamps_report.yaml           # where the learner answers, and which case it is
    kinds:
      qos:
        says: two ends of a topic do not match in their QoS
        shows: "`ros2 topic info --verbose` lists both ends, and their reliability differs."
    cases:
      - id: k7fd                        # says nothing to the learner
        what: qos                       # or a list, the best first
        where: lamp.py
        change: [...]                   # what of the solution becomes what, as in a test submission
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml


@dataclass(frozen=True)
class Kind:
    """A kind of fault. `says`: what it is, in words; `shows`: by what one would see that it is this."""

    says: str
    shows: str


@dataclass(frozen=True)
class Fault:
    """One case: the kinds that name it rightly, and the file that it is in."""

    what: tuple[str, ...]
    where: str


@dataclass(frozen=True, eq=False)
class Faults:
    """All kinds, by their ids, and all cases. `report`: the file with the learner's answer."""

    report: str
    kinds: Mapping[str, Kind]
    cases: Mapping[str, Fault]

    @classmethod
    def read(cls, file: Path) -> Faults:
        """Read the file. Raises ValueError if it is not as described above."""
        try:
            data = yaml.safe_load(file.read_text(encoding="utf-8"))
            kinds = {str(id): Kind(kind["says"], kind["shows"]) for id, kind in data["kinds"].items()}
            cases = {case["id"]: Fault(_several(case["what"]), case["where"]) for case in data["cases"]}
            return cls(data["report"], kinds, cases)
        except (OSError, yaml.YAMLError, KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"{file.name} cannot be read: {error}") from error


def _several(value: Any) -> tuple[str, ...]:
    return (value,) if isinstance(value, str) else tuple(value)
