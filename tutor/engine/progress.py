"""What a scenario is doing, and what is known so far of the nodes it waits for. Never a verdict, nor part of one."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Collection, Iterator, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

from tutor.content import LiveView
from tutor.content.near_miss import near_misses
from tutor.judge import tracebacks
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import MAX_LINE_CHARACTERS
from tutor.report.plain import one_line
from tutor.source import Program

if TYPE_CHECKING:
    from tutor.engine.run import RosRun  # imports rclpy, whose environment must be set by then
    from tutor.mistakes import Diagnosis

_SPINS = "spin", "spin_once", "spin_some", "spin_until_future_complete"
_MAX_NAMES = 3
SYMPTOM_ONLY = 3
"""The evidence of a mistake that nothing but its symptom shows (`tutor.mistakes.Evidence.SYMPTOM`)."""

QUIET_WAIT_S = 1.0
"""Waits shorter than this are not commented on."""

UPDATE_INTERVAL_S = 0.5
"""Minimum interval between updates."""


@dataclass(frozen=True, slots=True)
class SoFar:
    """A preliminary finding. `likely`: it names a likely cause, not only what is still missing."""

    text: str = ""
    likely: bool = False

    @property
    def weight(self) -> int:
        """How informative it is; of several, the one with the greatest weight is shown."""
        return bool(self.text) + self.likely


NOTHING = SoFar()


@dataclass(frozen=True, slots=True)
class RunSnapshot:
    """What is known about one run at one moment.

    `watched`: maps the topics on which messages are awaited to their types. `awaits_response`: whether a request is
    waiting for its response. `published_elsewhere`: topics on which another run of the same check has published; this
    run may be silent there on purpose, as its parameters demand.
    """

    trace: Trace
    watched: Mapping[str, str] = field(default_factory=dict)
    awaits_response: bool = False
    published_elsewhere: Collection[str] = ()


def describe(seen: RunSnapshot, requested: LiveView) -> SoFar:
    """Name the likely cause of what is missing, or else what is missing.

    `requested`: the names that the exercise asks for.
    """
    trace = seen.trace
    if trace.exit is not None:
        return _describe_exit(trace)
    raised = tracebacks.last_traceback(trace)
    if raised is not None and not raised.ignored:
        own = raised.own(trace.folder)
        return SoFar(f"{raised.raised}{f' ({own})' if own else ''}; the program still runs")
    if not trace.graph.nodes:
        return SoFar(f"the program runs{' and prints without end' if trace.dropped_lines else ''}, no node yet")
    found = (_likely(cause) for cause in _find_causes(seen, requested))
    return next(found, None) or SoFar(next(_describe_missing(seen, requested), ""))


def _describe_exit(trace: Trace) -> SoFar:
    assert trace.exit is not None
    if trace.exit.code == 0:  # perhaps as requested
        return SoFar("the program has ended, with exit code 0")
    return _likely(_why(Symptom.ENDED.seen(trace)).cause)


def _likely(cause: str) -> SoFar:
    return SoFar(f"likely {cause}", likely=True)


def _why(seen: Observation) -> Diagnosis:
    from tutor.mistakes import CATALOGUE, why  # late, since it reads the source

    return why(seen, [CATALOGUE])


def _find_causes(seen: RunSnapshot, requested: LiveView) -> Iterator[str]:
    """Yield the possible causes, the likeliest first; none where the learner is to find them."""
    if requested.has_hidden_fault:
        return
    trace, graph = seen.trace, seen.trace.graph
    silent = [topic for topic in _silent_topics(seen) if topic not in seen.published_elsewhere]
    for topic in silent:
        missing = _why(Symptom.NO_MESSAGES.seen(trace, topic=topic, type=seen.watched[topic]))
        if missing.evidence < SYMPTOM_ONLY:
            yield missing.cause
    for wanted in requested.topics:
        for subscription in graph.subscriptions:
            if subscription.topic == wanted.name and subscription.type != wanted.type:
                yield f"wrong type: {wanted.name} has the type {subscription.type}, not {wanted.type}"
    if not silent or not seen.watched:
        for miss in near_misses(graph, requested):
            yield f"wrong name: {miss.node} {miss.does} {miss.found}, not {miss.wanted}"
    if any(not service.is_standard for service in graph.servers):
        unmet = _why(Symptom.NO_ANSWER.seen(trace))
        if unmet.mistake == "incompatible-qos-of-a-service":
            yield unmet.cause
    program = Program(trace.sources, trace.file)
    if (silent or seen.awaits_response) and trace.sources and not program.calls(*_SPINS):
        yield f"no spin: {_describe_nodes(trace)}, and the program never calls rclpy.spin()"


def _describe_missing(seen: RunSnapshot, requested: LiveView) -> Iterator[str]:
    """Describe what has not come yet, the most informative first.

    Each text starts with the most important part, since its end may be cut off.
    """
    trace, up = seen.trace, partial(_describe_nodes, seen.trace)
    for topic in _silent_topics(seen):
        has_publisher = any(publisher.topic == topic for publisher in trace.graph.publishers)
        yield f"{'nothing published' if has_publisher else 'no publisher'} on {topic} yet, {up()}"
    if seen.awaits_response:
        yield f"no answer to a request yet, {up()}"
    graph = trace.graph
    offered = [server.name for server in graph.servers if not server.is_standard]
    lacking = [service for service in requested.services if not _is_found(service, offered)]
    if lacking and all(client.is_standard for client in graph.clients):
        yield f"no service {_join_names(lacking) if offered else 'or client'} yet, {up()}"
    endpoint_topics = [endpoint.topic for endpoint in (*graph.publishers, *graph.subscriptions)]
    for wanted in requested.topics:
        if not _is_found(wanted.name, endpoint_topics):
            yield f"no publisher or subscription on {wanted.name} yet, {up()}"
    heard = [
        subscription.topic
        for subscription in graph.subscriptions
        if subscription.topic in [topic.name for topic in requested.topics]
    ]
    if heard and not trace.logs:
        yield f"nothing logged yet, {up()} and subscribed to {heard[0]}"


def _is_found(wanted: str, found: Sequence[str]) -> bool:
    """Whether `found` has this name in any namespace: the exercise may require one."""
    return any(name.endswith(wanted) for name in found)


def _silent_topics(seen: RunSnapshot) -> list[str]:
    return [topic for topic in seen.watched if not seen.trace.samples_on(topic)]


def _describe_nodes(trace: Trace) -> str:
    nodes = list(dict.fromkeys(trace.graph.nodes))
    return f"{_join_names(nodes)} {'is' if len(nodes) == 1 else 'are'} up"


def _join_names(known: Sequence[str]) -> str:
    shown = [*known[:_MAX_NAMES], *([f"{len(known) - _MAX_NAMES} more"] if len(known) > _MAX_NAMES else [])]
    *most, last = shown
    return f"{', '.join(most)} and {last}" if most else last


class ScenarioProgress:
    """Combines the progress of one scenario with preliminary findings about its runs.

    `on_progress` gets both as (fraction, doing, so far). `requested`: names that the exercise asks for. `published`:
    topics on which any run of the check has published; a set that all scenarios of the check share and update.
    """

    def __init__(
        self, on_progress: Callable[[float, str, SoFar], None], requested: LiveView, published: set[str]
    ) -> None:
        self._on_progress, self._requested, self._published = on_progress, requested, published
        self._followed: list[_FollowedRun] = []
        self._polling: asyncio.Task[None] | None = None
        self._fraction, self._doing, self._so_far = 0.0, "", NOTHING
        self._since = time.monotonic()

    def report(self, fraction: float, doing: str) -> None:
        """Take in the scenario's progress. A new step clears the findings of the step before."""
        if doing != self._doing:
            self._doing, self._so_far, self._since = doing, NOTHING, time.monotonic()
        self._fraction = fraction
        self._on_progress(fraction, doing, self._so_far)

    @asynccontextmanager
    async def follow(self, run: RosRun, watched: Mapping[str, str]) -> AsyncIterator[None]:
        """Poll this run within the block; `watched` maps the topics whose messages are collected to their types."""
        followed = _FollowedRun(run, watched)
        self._followed.append(followed)
        if self._polling is None:
            self._polling = asyncio.ensure_future(self._poll())
        try:
            yield
        finally:
            self._followed.remove(followed)
            if not self._followed:
                polling, self._polling = self._polling, None
                polling.cancel()
                await asyncio.gather(polling, return_exceptions=True)  # an error in here changes no verdict
        if not self._followed and not self._so_far.likely:
            self._update(NOTHING)

    async def _poll(self) -> None:
        while True:
            await asyncio.sleep(max(UPDATE_INTERVAL_S, self._since + QUIET_WAIT_S - time.monotonic()))
            if time.monotonic() < self._since + QUIET_WAIT_S:
                continue
            found = [followed.describe(self._requested, self._published) for followed in self._followed]
            self._update(max(found, key=lambda so_far: so_far.weight, default=NOTHING))

    def _update(self, so_far: SoFar) -> None:
        # The text may contain output of the program.
        so_far = replace(so_far, text=one_line(so_far.text, MAX_LINE_CHARACTERS))
        if so_far != self._so_far:
            self._so_far = so_far
            self._on_progress(self._fraction, self._doing, so_far)


class _FollowedRun:
    """One run, with its latest state and the description of it."""

    def __init__(self, run: RosRun, watched: Mapping[str, str]) -> None:
        self._run, self._watched = run, watched
        self._state: object = None
        self._description = NOTHING

    def describe(self, requested: LiveView, published: set[str]) -> SoFar:
        """Describe the run as it is now; reuse the description if nothing relevant has changed. Updates `published`."""
        run = self._run
        if run.interrupted_at is not None:
            late = run.exit is None and run.now() - run.interrupted_at >= QUIET_WAIT_S
            return SoFar("it has not ended after Ctrl+C yet") if late else NOTHING
        published.update(topic for topic in self._watched if run.samples_on(topic))
        graph = run.peek_graph()
        state = (
            run.exit,
            graph,
            run.awaits_response,
            sum(line.stream == "stderr" for line in run.output),
            bool(run.logs),
            [topic for topic in self._watched if run.samples_on(topic)],
            published.intersection(self._watched),
        )
        if state != self._state:
            self._state = state
            snapshot = RunSnapshot(run.trace_of(graph), self._watched, run.awaits_response, frozenset(published))
            self._description = describe(snapshot, requested)
        return self._description
