"""Forms: a lifecycle node makes its transitions, and publishes in the state "active" alone."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form
from tutor.exercise.lifecycle_judge import judge_part
from tutor.exercise.lifecycle_walk import LifecycleRun, Move, Walk
from tutor.exercise.nouns import Lifecycle, Value, show
from tutor.judge.check import Criterion
from tutor.judge.verdict import Status, Verdict


@dataclass(frozen=True)
class LifecycleForm(Form):
    """A criterion about a part of a lifecycle node's life, which all such criteria walk through together."""

    lifecycle: Lifecycle

    @property
    @abstractmethod
    def moves(self) -> tuple[Move, ...]:
        """What this criterion adds to the walk."""

    @property
    @abstractmethod
    def expected(self) -> str:
        """What must be seen, in words."""

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, _whole_life(exercise, self.lifecycle))

    def judge(self, seen: LifecycleRun) -> Verdict:
        """Judge this criterion's part of the walk."""
        return judge_part(seen, self.lifecycle, self.moves, self.expected)


def _whole_life(exercise: Exercise, lifecycle: Lifecycle) -> Walk:
    """The walk through all parts that the exercise has criteria for, and the transitions that lead there."""
    own = [form for form in exercise.forms if isinstance(form, LifecycleForm) and form.lifecycle == lifecycle]
    last = max((_ORDER.index(type(form)) for form in own if type(form) in _ORDER), default=0)
    parts: list[LifecycleForm] = [
        kind("", lifecycle) for kind in (BeginsUnconfigured, Configures, Activates, Deactivates)
    ]
    parts += sorted((form for form in own if isinstance(form, CleansUp | ShutsDown)), key=_place)
    moves = [move for part in parts if _place(part) <= last for move in part.moves]
    return Walk(exercise.program, lifecycle, tuple(moves), expected_s=6.0)


def _place(form: LifecycleForm) -> int:
    return _ORDER.index(type(form))


@dataclass(frozen=True)
class BeginsUnconfigured(LifecycleForm):
    """A lifecycle node is "unconfigured" at its start: it is silent, and cannot be activated yet."""

    @property
    def moves(self) -> tuple[Move, ...]:
        start = Move("start", "", "unconfigured", "silence")
        return start, Move("start", "activate", "unconfigured", refused=True)

    @property
    def expected(self) -> str:
        return f"{self.lifecycle.node} begins unconfigured, publishes nothing, and cannot be activated yet"


@dataclass(frozen=True)
class Configures(LifecycleForm):
    """The transition "configure" makes the publisher, which is silent as long as the node is inactive."""

    @property
    def moves(self) -> tuple[Move, ...]:
        return (Move("configure", "configure", "inactive", "publisher"),)

    @property
    def expected(self) -> str:
        topic = self.lifecycle.topic
        return f"configured, the node is inactive, with a publisher of {topic.type} on {topic.name} that is silent"


@dataclass(frozen=True)
class Activates(LifecycleForm):
    """The active node publishes at the rate that its parameter says by default."""

    @property
    def moves(self) -> tuple[Move, ...]:
        return (Move("activate", "activate", "active", "rate", self.lifecycle.default_hz),)

    @property
    def expected(self) -> str:
        return f"activated, it publishes on {self.lifecycle.topic.name} at {self.lifecycle.default_hz:g} Hz"


@dataclass(frozen=True)
class Deactivates(LifecycleForm):
    """The node that is deactivated is silent; activated again, it publishes at the same rate as before."""

    @property
    def moves(self) -> tuple[Move, ...]:
        hz = self.lifecycle.default_hz
        silent = Move("deactivate", "deactivate", "inactive", "silence", hz)
        return silent, Move("deactivate", "activate", "active", "rate", hz)

    @property
    def expected(self) -> str:
        hz = self.lifecycle.default_hz
        return f"deactivated, it is inactive and silent; activated again, it publishes at {hz:g} Hz as before"


@dataclass(frozen=True)
class CleansUp(LifecycleForm):
    """After "cleanup", the publisher is gone; configured again, the node takes the new value of its parameter.

    `again_hz`: the rate that it is set to before that. One below the default shows a timer that is left.

        CleansUp("cleanup", CAMERA, again_hz=2.0, after=deactivates)
    """

    again_hz: float

    @property
    def moves(self) -> tuple[Move, ...]:
        return (
            Move("cleanup", "deactivate", "inactive"),
            Move("cleanup", "cleanup", "unconfigured", "nothing left"),
            Move("cleanup", "configure", "inactive", set_to=self.again_hz),
            Move("cleanup", "activate", "active", "rate", self.again_hz),
        )

    @property
    def expected(self) -> str:
        name, rate = self.lifecycle.topic.name, self.lifecycle.rate.name
        return (
            f"after a cleanup, the publisher on {name} is gone; configured again with {rate} {self.again_hz:g}, "
            f"the node publishes at {self.again_hz:g} Hz"
        )


@dataclass(frozen=True)
class FailsToConfigure(LifecycleForm):
    """With a bad value of its parameter, the node fails to configure and stays unconfigured; a good one is taken.

    `bad`: the values, the first one given at the start. `good`: the one after them.

        FailsToConfigure("bad-value", CAMERA, bad=(-1.0, 0.0), good=4.0, after=configures)
    """

    bad: tuple[Value, ...]
    good: Value

    @property
    def moves(self) -> tuple[Move, ...]:
        refused = [
            Move("bad", "configure", "unconfigured", refused=True, set_to=bad if number else None)
            for number, bad in enumerate(self.bad)
        ]
        return (*refused, Move("bad", "configure", "inactive", set_to=self.good))

    @property
    def expected(self) -> str:
        name, values = self.lifecycle.rate.name, " and ".join(show(bad) for bad in self.bad)
        return (
            f"with {name} {values}, it fails to configure and stays unconfigured; with {show(self.good)}, it does not"
        )

    def criterion(self, exercise: Exercise) -> Criterion:
        start = Move("start", "", "unconfigured")
        walk = Walk(exercise.program, self.lifecycle, (start, *self.moves), starts_with=self.bad[0])
        return self.judged(self.judge, walk)


@dataclass(frozen=True)
class ShutsDown(LifecycleForm):
    """The transition "shutdown" finalizes the node from each of its states, and the node is silent then.

    The program may go on, or end with 0.
    """

    @property
    def moves(self) -> tuple[Move, ...]:
        return (Move("shutdown", "shutdown", "finalized", "silence"),)

    @property
    def expected(self) -> str:
        return "shut down while unconfigured, inactive or active, the node is finalized, and silent"

    def criterion(self, exercise: Exercise) -> Criterion:
        start, configure = Move("start", "", "unconfigured"), Move("start", "configure", "inactive")
        lives = [
            Walk(exercise.program, self.lifecycle, (start, *self.moves)),
            Walk(exercise.program, self.lifecycle, (start, configure, *self.moves)),
        ]
        return self.judged(self.judge_all, *lives, _whole_life(exercise, self.lifecycle))

    def judge_all(self, *seen: LifecycleRun) -> Verdict:
        """Judge the shutdown from each state: the first one that does not pass."""
        verdicts = [self.judge(run) for run in seen]
        return next((verdict for verdict in verdicts if verdict.status is not Status.PASSED), verdicts[-1])


_ORDER: tuple[type[LifecycleForm], ...] = (BeginsUnconfigured, Configures, Activates, Deactivates, CleansUp, ShutsDown)
"""The parts of a life, in the order in which a walk goes through them."""
