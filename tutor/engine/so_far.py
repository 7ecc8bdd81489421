"""Describe briefly what is known about a node that is still waited for. Pure; never a verdict, nor part of one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

from tutor.content import LiveView
from tutor.content.near_miss import near_misses
from tutor.judge import tracebacks
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.source import Program

if TYPE_CHECKING:
    from tutor.mistakes import Diagnosis

_SPINS = "spin", "spin_once", "spin_some", "spin_until_future_complete"
_MAX_NAMES = 3
SYMPTOM_ONLY = 3
"""The evidence of a mistake that nothing but its symptom shows (`tutor.mistakes.Evidence.SYMPTOM`)."""


@dataclass(frozen=True, slots=True)
class SoFar:
    """A preliminary finding. `likely`: it names a likely cause, not only what is still missing."""

    text: str = ""
    likely: bool = False

    @property
    def weight(self) -> int:
        """How informative it is; of several, the one with the greatest weight is shown."""
        return bool(self.text) + self.likely


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
    """Yield the possible causes, the likeliest first."""
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
        has_publisher = any(each.topic == topic for each in trace.graph.publishers)
        yield f"{'nothing published' if has_publisher else 'no publisher'} on {topic} yet, {up()}"
    if seen.awaits_response:
        yield f"no answer to a request yet, {up()}"
    graph = trace.graph
    offered = [each.name for each in graph.servers if not each.is_standard]
    lacking = [each for each in requested.services if not _is_found(each, offered)]
    if lacking and all(each.is_standard for each in graph.clients):
        yield f"no service {_join_names(lacking) if offered else 'or client'} yet, {up()}"
    endpoint_topics = [each.topic for each in (*graph.publishers, *graph.subscriptions)]
    for wanted in requested.topics:
        if not _is_found(wanted.name, endpoint_topics):
            yield f"no publisher or subscription on {wanted.name} yet, {up()}"
    heard = [each.topic for each in graph.subscriptions if each.topic in [topic.name for topic in requested.topics]]
    if heard and not trace.logs:
        yield f"nothing logged yet, {up()} and subscribed to {heard[0]}"


def _is_found(wanted: str, found: Sequence[str]) -> bool:
    """Whether `found` has this name in any namespace: the exercise may require one."""
    return any(each.endswith(wanted) for each in found)


def _silent_topics(seen: RunSnapshot) -> list[str]:
    return [topic for topic in seen.watched if not seen.trace.samples_on(topic)]


def _describe_nodes(trace: Trace) -> str:
    nodes = list(dict.fromkeys(trace.graph.nodes))
    return f"{_join_names(nodes)} {'is' if len(nodes) == 1 else 'are'} up"


def _join_names(known: Sequence[str]) -> str:
    shown = [*known[:_MAX_NAMES], *([f"{len(known) - _MAX_NAMES} more"] if len(known) > _MAX_NAMES else [])]
    *most, last = shown
    return f"{', '.join(most)} and {last}" if most else last
