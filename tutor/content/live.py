"""What a lesson is about on DDS, for the app: what to look at, and which of our nodes go with the learner's."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class LiveTopic:
    """A topic that the exercise asks for. `band`: between which values the exercise wants its numbers, if it does."""

    name: str
    type: str
    band: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Partner:
    """One of our nodes, to be started beside the learner's own.

    It is either `run`, the words that follow `ros2 run`, or a Python `file`. `beside` is the learner's file that it
    goes with; empty where it goes with any.
    """

    name: str
    does: str
    run: tuple[str, ...] = ()
    file: Path | None = None
    beside: str = ""


@dataclass(frozen=True, slots=True)
class LiveView:
    """What of a lesson is to be seen live. The first topic, and the first service, are shown first."""

    topics: tuple[LiveTopic, ...] = ()
    services: tuple[str, ...] = ()
    partners: tuple[Partner, ...] = ()

    def partner_of(self, file: str) -> Partner | None:
        """The partner of one of the learner's files, if it has one."""
        return next((partner for partner in self.partners if partner.beside in ("", file)), None)

    def band_of(self, topic: str) -> tuple[float, float] | None:
        """The values that are asked for on a topic, from the lowest to the highest."""
        return next((known.band for known in self.topics if known.name == topic), None)
