"""A walk through the states of a lifecycle node: we ask for one transition after another, and look what it does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

from tutor.exercise.nouns import Lifecycle, Program, Value
from tutor.exercise.run_time_changes import QUIET_PERIODS
from tutor.exercise.seen_run import Seen, look
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import is_race
from tutor.judge.rates import Rate
from tutor.judge.trace import CallAnswer, Sample, SetAnswer
from tutor.judge.waiting_for_nodes import (
    IDLE_S,
    IN_FLIGHT_S,
    RESENT_S,
    measure_steady_rate,
    patience_s,
    wait_until_seen,
)

ANSWER_S = 5.0
"""Time limit for the answer to a request."""

RESEND_S = 1.5
"""When a request for the state is sent once more."""

LISTEN_S = 1.15
"""Time within which a timer of 1 s shows, as a node has that somebody begins with: where it must be silent for longer.
"""

END_S = 2.0
"""Time in which a process ends that an exception in a callback, or a shutdown, has ended."""

CHANGE_STATE, GET_STATE = "lifecycle_msgs/srv/ChangeState", "lifecycle_msgs/srv/GetState"

_EVENT = "lifecycle_msgs/msg/TransitionEvent"
_IDS = {"configure": 1, "cleanup": 2, "activate": 3, "deactivate": 4}
_SHUTDOWN_IDS = {"unconfigured": 5, "inactive": 6, "active": 7}

Watched = Literal["state", "silence", "publisher", "rate", "nothing left"]
"""What is looked at after a transition: the state alone, or also what the node publishes.

"publisher": it has its publisher, and is silent. "nothing left": it has none, or no longer.
"""


@dataclass(frozen=True)
class Move:
    """A transition that we ask for, and what must be seen then.

    `part`: what the criterion that judges it asks for. `transition`: "" for what is seen at the start. `to`: the state
    that the node must be in then. `refused`: the node must fail in it. `set_to`: what the parameter is set to before.
    `hz`: the rate to be seen, if the node is active then, or that it had before. `listen_s`: how long it must be silent
    at least.
    """

    part: str
    transition: str
    to: str
    watched: Watched = "state"
    hz: float = 0.0
    listen_s: float = 0.0
    refused: bool = False
    set_to: Value | None = None


@dataclass(frozen=True)
class Step:
    """What was seen of a move.

    `set_to`: the answer to setting the parameter; None if it was not set. `change`: the answer to our request, None if
    we made none. `state`: "" if the node did not say. `through`: the states that it reports to have been in meanwhile.
    `ended`: the process ended, and with 0. `ended_badly`: the node was finalized, and then it ended with another exit
    code. `publishes`: it has its publisher. `sent`: messages where none should come. `rate`, `messages`: how they come
    when it is active.
    """

    move: Move
    set_to: SetAnswer | None = None
    change: CallAnswer | None = None
    state: str = ""
    through: tuple[str, ...] = ()
    ended: bool = False
    ended_badly: bool = False
    publishes: bool = False
    sent: tuple[Sample, ...] = ()
    rate: Rate | None = None
    messages: int = 0

    @property
    def answered(self) -> bool:
        """Whether the node has answered our request, and said its state."""
        return (self.change is None or self.change.response is not None) and bool(self.state)

    @property
    def succeeded(self) -> bool:
        """Whether the node says that it has made the transition."""
        return self.change is not None and self.change.response is not None and bool(self.change.response["success"])

    @property
    def state_is_right(self) -> bool:
        """Whether the node is where it should be."""
        if self.ended and self.move.to == "finalized":
            return True
        made_it = self.change is None or self.succeeded is not self.move.refused
        return self.answered and made_it and self.state == self.move.to

    @property
    def is_right(self) -> bool:
        """Whether everything is as it should be."""
        if not self.state_is_right or self.sent or self.ended_badly:
            return False
        match self.move.watched:
            case "publisher":
                return self.publishes
            case "nothing left":
                return not self.publishes
            case "rate":
                return self.rate is not None and self.rate.agrees_with(self.move.hz)
        return True


@dataclass(frozen=True)
class LifecycleRun(Seen):
    """What a lifecycle node did on our requests, until something was not as it should be.

    `offered`: whether it has the services for them.
    """

    offered: bool = True
    steps: tuple[Step, ...] = ()


@dataclass(frozen=True)
class Walk:
    """Start with the parameter set to `starts_with`, or without parameters, and make the moves one after another."""

    program: Program
    lifecycle: Lifecycle
    moves: tuple[Move, ...]
    starts_with: Value | None = None
    expected_s: float = field(default=2.0, compare=False)

    async def __call__(self, bench: Bench) -> LifecycleRun:
        lifecycle = self.lifecycle
        given = None if self.starts_with is None else {lifecycle.rate.name: self.starts_with}
        watch = {**lifecycle.topic.watched, f"{lifecycle.node}/transition_event": _EVENT}
        async with bench.start(self.program.file, parameters=given, watch=watch, expected_s=self.expected_s) as run:
            bench.report_progress(0.05, f"waiting for the services of {lifecycle.node}")
            steps: list[Step] = []
            offered = await wait_for_services(run, lifecycle)
            for number, move in enumerate(self.moves if offered else ()):
                bench.report_progress(0.1 + 0.8 * number / len(self.moves), move.transition or "asking for its state")
                period_s = 1 / rate_in_effect(lifecycle, move, steps)
                steps.append(await make_move(run, lifecycle, move, steps[-1].state if steps else "", period_s))
                if not steps[-1].is_right:
                    break
            does_nothing = not offered or (bool(steps) and not steps[-1].answered)
            return (await look(run, does_nothing=does_nothing)).having(
                LifecycleRun, offered=offered, steps=tuple(steps)
            )


def rate_in_effect(lifecycle: Lifecycle, move: Move, before: Sequence[Step]) -> float:
    """The rate, in Hz, at which a node publishes that a move does not stop, or stops too late.

    `before`: the steps before that move.
    """
    rates = [step.move.hz for step in before if step.move.watched == "rate"]
    return move.hz or (rates[-1] if rates else lifecycle.default_hz)


async def wait_for_services(run: Run, lifecycle: Lifecycle) -> bool:
    """Wait for the services by which the node is asked for transitions, and for its state."""
    name = f"{lifecycle.node}/change_state"
    wanted = {(name, CHANGE_STATE), (f"{lifecycle.node}/get_state", GET_STATE)}

    def servers() -> list[tuple[str, str]]:
        return [(server.name, server.type) for server in run.graph.servers]

    return await wait_until_seen(
        run, lambda: wanted <= set(servers()), settle_s=lambda: patience_s(servers(), name, CHANGE_STATE)
    )


async def make_move(run: Run, lifecycle: Lifecycle, move: Move, state: str, period_s: float) -> Step:
    """Make a move, from a state, and look what the node does then; see `_look_at_topic`."""
    answer: SetAnswer | None = None
    if move.set_to is not None:
        answer = await run.set_parameters(lifecycle.node, {lifecycle.rate.name: move.set_to}, limit_s=ANSWER_S)
        if not answer.successful:
            return Step(move, answer, state=state)
    change: CallAnswer | None = None
    since = run.now()
    if move.transition:
        number = _IDS.get(move.transition) or _SHUTDOWN_IDS[state]
        request = {"transition": {"id": number, "label": move.transition}}
        change = await run.call(f"{lifecycle.node}/change_state", CHANGE_STATE, request, limit_s=ANSWER_S)
        since = change.answered_at
    now_in = await _state(run, lifecycle) if change is None or change.response is not None else ""
    if not now_in:
        await run.wait_for_exit(END_S, all_sent=lambda: True)
    ended = run.exit is not None and run.exit.code == 0
    through = _states_reported(run, lifecycle, change.asked_at) if change is not None else ()
    step = Step(move, answer, change, now_in, through, ended)
    if not step.state_is_right:
        return step
    return await _look_at_topic(run, lifecycle, step, since, period_s, was_active=state == "active")


async def _state(run: Run, lifecycle: Lifecycle) -> str:
    answer = await run.call(f"{lifecycle.node}/get_state", GET_STATE, {}, limit_s=ANSWER_S, resend_s=RESEND_S)
    return str(answer.response["current_state"]["label"]) if answer.response is not None else ""


def _states_reported(run: Run, lifecycle: Lifecycle, since: float) -> tuple[str, ...]:
    events = run.samples_on(f"{lifecycle.node}/transition_event")
    return tuple(str(event.message["goal_state"]["label"]) for event in events if event.source_time >= since)


async def _look_at_topic(
    run: Run, lifecycle: Lifecycle, step: Step, since: float, period_s: float, *, was_active: bool
) -> Step:
    """Look at what the node publishes after a transition that it has made, from a time on.

    `period_s`: between two messages, if it publishes.
    """
    topic, move = lifecycle.topic, step.move

    def publishes() -> bool:
        return any((found.topic, found.type) == (topic.name, topic.type) for found in run.graph.publishers)

    def sent(after: float) -> tuple[Sample, ...]:
        return tuple(sample for sample in run.samples_on(topic.name) if sample.source_time > after)

    if move.watched in ("silence", "publisher"):
        # A callback that runs in another thread may be about to publish when the node is deactivated.
        quiet_from = since + (period_s + IN_FLIGHT_S if was_active else 0.0)
        # The limit is longer by what the node waits for a CPU: meanwhile it is silent, whatever it means to do.
        quiet_until = quiet_from + max(QUIET_PERIODS * period_s, move.listen_s) + IN_FLIGHT_S
        await run.until(lambda: bool(sent(quiet_from)), quiet_until - run.now(), idle_s=IDLE_S)
        step = replace(step, sent=sent(quiet_from), ended_badly=move.to == "finalized" and _ended_badly(run))
    if move.watched == "publisher":
        await run.until(publishes, RESENT_S, idle_s=RESENT_S)
        return replace(step, publishes=publishes())
    if move.watched == "nothing left":
        if move.refused:  # what it has made in vain may not be in the graph yet
            await run.until(publishes, IN_FLIGHT_S, idle_s=IDLE_S)
        await run.until(lambda: not publishes(), RESENT_S, idle_s=RESENT_S)
        return replace(step, publishes=publishes())
    if move.watched == "rate":
        # Long enough for a rate that is taken for a period.
        if not await run.until(lambda: bool(sent(since)), max(2 / move.hz, move.hz) + 2, idle_s=IDLE_S):
            return step
        rate, messages = await measure_steady_rate(run, topic.name, move.hz, since=since)
        return replace(step, rate=rate, messages=messages or len(sent(since)))
    return step


def _ended_badly(run: Run) -> bool:
    """Whether the process has ended by itself, with an exit code that says that something went wrong.

    That is not for a crash in C or C++ code, or a race in rclpy, as a correct program may have when it ends.
    """
    return run.exit is not None and run.exit.code not in (None, 0) and not is_race(run.output)
