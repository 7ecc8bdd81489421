"""Our own endpoints that a learner's node communicates with: publishers, action clients, and servers.

A scenario gets them from its bench (`tutor.judge.bench`). The implementations on real DDS are in `tutor.ros`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from tutor.judge.trace import GoalAnswer, HeldRequest, Sample, ServedGoal
from tutor.ros_model import QoS, TopicEndpoint

Handler = Callable[[Mapping[str, Any]], Mapping[str, Any]]
"""Answers one service request (fields to values) with a response (fields to values)."""


@dataclass(frozen=True, slots=True)
class Offer:
    """A publisher of ours that is there before a process starts, and has published `messages` by then.

    `qos`: what it offers, of which only reliability and durability are taken. `depth`: how many messages it keeps.
    """

    topic: str
    type: str
    qos: QoS
    depth: int
    messages: tuple[Mapping[str, Any], ...] = ()


class Publisher(Protocol):
    """Our publisher on the learner's domain; unless an `Offer` says more, reliable, volatile, and of depth 10."""

    @property
    def endpoint(self) -> TopicEndpoint:
        """The endpoint as the learner's node sees it in the graph."""

    @property
    def subscribers(self) -> int:
        """How many subscriptions it is matched with now."""

    @property
    def matches(self) -> int:
        """How many subscriptions it has been matched with so far, those that have gone away included."""

    def publish(self, message: Mapping[str, Any]) -> Sample:
        """Publish a message (fields to values) at once; return it with the time at which it was sent."""


class GoalClient(Protocol):
    """Our client of an action of the learner's, for one goal."""

    @property
    def matched(self) -> bool:
        """Whether it is matched with an action server now."""

    @property
    def seen(self) -> GoalAnswer:
        """What has become of the goal so far."""

    def send(self, goal: Mapping[str, Any]) -> None:
        """Send the goal (fields to values), and ask for its result if it is accepted."""

    def cancel(self) -> None:
        """Ask the server to cancel the goal, which must have been accepted."""


@dataclass(frozen=True)
class GoalReplies:
    """What our action server does with each goal: it rejects it, or sends feedback step by step, and then the result.

    `feedback` and `result`: fields to values; before each message and before the result, `step_s` seconds pass.
    """

    accepts: bool = True
    feedback: tuple[Mapping[str, Any], ...] = ()
    result: Mapping[str, Any] = field(default_factory=dict)
    step_s: float = 0.3


class GoalServer(Protocol):
    """Our server of an action for the learner's clients. It is not there until it is opened."""

    @property
    def goals(self) -> Sequence[ServedGoal]:
        """The goals that it has got so far, and how far each of them is."""

    def open(self) -> None:
        """Let it appear in the graph."""


class HoldingServer(Protocol):
    """Our server of one service, which replies to each request when it is told to, or never."""

    @property
    def requests(self) -> Sequence[HeldRequest]:
        """The requests that it has taken so far, replied to or not."""

    def reply(self, request: HeldRequest, response: Mapping[str, Any]) -> None:
        """Reply to a request (fields to values); a second reply to the same one does nothing."""
