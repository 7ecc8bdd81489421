"""What the app shows live of a lesson's ROS graph, and which of our nodes run alongside the learner's."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class LiveTopic:
    """A topic that the exercise requires. `band`: the range (low, high) required of its numbers, if there is one."""

    name: str
    type: str
    band: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Partner:
    """One of our nodes, to be started alongside the learner's.

    It is given either as `run`, the words after `ros2 run`, or as a Python `file`. `beside` is the learner's file that
    it goes with; empty if it goes with any. `does` says what the node does.
    """

    name: str
    does: str
    run: tuple[str, ...] = ()
    file: Path | None = None
    beside: str = ""

    @property
    def key(self) -> Path:
        """What tells its runs from those of other partners and of learners' nodes, which are known by their file."""
        return self.file or Path(*self.run)


@dataclass(frozen=True, slots=True)
class LiveView:
    """The topics, services and partner nodes that the app shows for a lesson; the first ones are shown first.

    `has_hidden_fault`: the learner is to find what differs from it, so that nothing may point to that.
    """

    topics: tuple[LiveTopic, ...] = ()
    services: tuple[str, ...] = ()
    partners: tuple[Partner, ...] = ()
    has_hidden_fault: bool = False

    def partner_of(self, file: str) -> Partner | None:
        """Return the partner of one of the learner's files, if it has one."""
        return next((partner for partner in self.partners if partner.beside in ("", file)), None)

    def band_of(self, topic: str) -> tuple[float, float] | None:
        """Return the range (low, high) that the exercise requires on a topic, if there is one."""
        return next((known.band for known in self.topics if known.name == topic), None)
