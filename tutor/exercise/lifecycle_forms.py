"""Forms: a lifecycle node makes its transitions, and publishes in the state "active" alone."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace

from tutor.exercise.form import Exercise, Form
from tutor.exercise.lifecycle_judge import judge_part
from tutor.exercise.lifecycle_walk import LISTEN_S, LifecycleRun, Move, Walk
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

    def judged_with_rest(self, exercise: Exercise, before: tuple[Move, ...], at_rest: Move) -> Criterion:
        """The criterion judged on a life at rest as well: one that goes no further, and listens for longer.

        So the walk through all parts, which takes longest, need not wait for that. `before`: the moves that lead to the
        one `at_rest`.
        """

        def judge(resting: LifecycleRun, seen: LifecycleRun) -> Verdict:
            return _first_not_passed(judge_part(resting, self.lifecycle, (at_rest,), self.expected), self.judge(seen))

        return self.judged(
            judge, _life_at_rest(exercise, self.lifecycle, *before, at_rest), _whole_life(exercise, self.lifecycle)
        )


_START = Move("start", "", "unconfigured")
_AT_START = replace(_START, watched="silence", listen_s=LISTEN_S)
_CONFIGURE = Move("configure", "configure", "inactive")
_CONFIGURED = replace(_CONFIGURE, watched="publisher", listen_s=LISTEN_S)


def _life_at_rest(exercise: Exercise, lifecycle: Lifecycle, *moves: Move) -> Walk:
    """A walk that makes these moves and ends with the shutdown, if the exercise has a criterion for that."""
    shutdown = exercise.first(ShutsDown, lambda form: form.lifecycle == lifecycle)
    return Walk(exercise.program, lifecycle, (*moves, *(shutdown.moves if shutdown is not None else ())))


def _first_not_passed(*verdicts: Verdict) -> Verdict:
    return next((verdict for verdict in verdicts if verdict.status is not Status.PASSED), verdicts[-1])


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
        return _START, Move("start", "activate", "unconfigured", refused=True)

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged_with_rest(exercise, (), _AT_START)

    @property
    def expected(self) -> str:
        return f"{self.lifecycle.node} begins unconfigured, publishes nothing, and cannot be activated yet"


@dataclass(frozen=True)
class Configures(LifecycleForm):
    """The transition "configure" makes the publisher, which is silent as long as the node is inactive."""

    @property
    def moves(self) -> tuple[Move, ...]:
        return (_CONFIGURE,)

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged_with_rest(exercise, (_START,), _CONFIGURED)

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
        silent = Move("deactivate", "deactivate", "inactive", "silence", hz, LISTEN_S)
        return silent, Move("deactivate", "activate", "active", "rate", hz)

    @property
    def expected(self) -> str:
        hz = self.lifecycle.default_hz
        return f"deactivated, it is inactive and silent; activated again, it publishes at {hz:g} Hz as before"


@dataclass(frozen=True)
class CleansUp(LifecycleForm):
    """After "cleanup", the publisher is gone; configured again, the node is silent, and active, it has the new rate.

    `again_hz`: the rate that it is set to before that. One below the default shows a timer that is left.

        CleansUp("cleanup", CAMERA, again_hz=2.0, after=deactivates)
    """

    again_hz: float

    @property
    def moves(self) -> tuple[Move, ...]:
        return (
            Move("cleanup", "deactivate", "inactive"),
            Move("cleanup", "cleanup", "unconfigured", "nothing left"),
            Move("cleanup", "configure", "inactive", "silence", self.again_hz, set_to=self.again_hz),
            Move("cleanup", "activate", "active", "rate", self.again_hz),
        )

    @property
    def expected(self) -> str:
        name, rate = self.lifecycle.topic.name, self.lifecycle.rate.name
        return (
            f"after a cleanup, the publisher on {name} is gone; configured again with {rate} {self.again_hz:g}, "
            f"the node is silent, and activated, it publishes at {self.again_hz:g} Hz"
        )


@dataclass(frozen=True)
class FailsToConfigure(LifecycleForm):
    """With a bad value of its parameter, the node fails to configure, and has no publisher then; a good one is taken.

    `bad`: the values, the first one given at the start. `good`: the one after them. Nothing is measured with it, so it
    may be one that a careless check takes for a bad one.

        FailsToConfigure("bad-value", CAMERA, bad=(-1.0, 0.0), good=0.5, after=configures)
    """

    bad: tuple[Value, ...]
    good: Value

    @property
    def moves(self) -> tuple[Move, ...]:
        refused = [
            Move("bad", "configure", "unconfigured", "nothing left", refused=True, set_to=bad if number else None)
            for number, bad in enumerate(self.bad)
        ]
        return (*refused, Move("bad", "configure", "inactive", set_to=self.good))

    @property
    def expected(self) -> str:
        name, values = self.lifecycle.rate.name, " and ".join(show(bad) for bad in self.bad)
        return (
            f"with {name} {values}, it fails to configure and stays unconfigured, without a publisher; "
            f"with {show(self.good)}, it is configured"
        )

    def criterion(self, exercise: Exercise) -> Criterion:
        walk = Walk(exercise.program, self.lifecycle, (_START, *self.moves), starts_with=self.bad[0])
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
        lives = [_life_at_rest(exercise, self.lifecycle, *moves) for moves in ((_AT_START,), (_START, _CONFIGURED))]
        return self.judged(self.judge_all, *lives, _whole_life(exercise, self.lifecycle))

    def judge_all(self, *seen: LifecycleRun) -> Verdict:
        """Judge the shutdown from each state: the first one that does not pass."""
        return _first_not_passed(*map(self.judge, seen))


_ORDER: tuple[type[LifecycleForm], ...] = (BeginsUnconfigured, Configures, Activates, Deactivates, CleansUp, ShutsDown)
"""The parts of a life, in the order in which a walk goes through them."""
