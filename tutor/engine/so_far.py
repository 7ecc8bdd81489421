"""What is known of a node while it is still waited for, in a few words. Pure; never a verdict, and never for one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

from tutor.content import LiveView
from tutor.content.near_miss import near_misses
from tutor.judge import causes, source, tracebacks
from tutor.judge.causes import names
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_SPINS = "spin", "spin_once", "spin_some", "spin_until_future_complete"
_MOST_NAMES = 3


@dataclass(frozen=True, slots=True)
class SoFar:
    """Words that are not final. `likely`: they name a cause, and not only what is missing yet."""

    text: str = ""
    likely: bool = False

    @property
    def weight(self) -> int:
        """Of several, the one with the greatest weight says most."""
        return bool(self.text) + self.likely


@dataclass(frozen=True, slots=True)
class Moment:
    """What is known of one start by now.

    `watched`: the topics on which messages are waited for, each with its type; `unanswered`: a request waits for its
    answer. `elsewhere`: the topics on which another start of the same check has
    published: that this one does not may be what was asked of it.
    """

    trace: Trace
    watched: Mapping[str, str] = field(default_factory=dict)
    unanswered: bool = False
    elsewhere: Collection[str] = ()


def describe(seen: Moment, asked: LiveView) -> SoFar:
    """The likely cause of what is missing, or else what is missing; `asked`: the names that the exercise asks for."""
    trace = seen.trace
    if trace.exit is not None:
        return _ended(trace)
    raised = tracebacks.last_traceback(trace)
    if raised is not None and not raised.ignored:
        own = raised.own(trace.folder)
        return SoFar(f"{raised.raised}{f' ({own})' if own else ''}; the program still runs")
    if not trace.graph.nodes:
        return SoFar(f"the program runs{' and prints without end' if trace.dropped_lines else ''}, no node yet")
    found = (_likely(cause) for cause in _causes(seen, asked))
    return next(found, None) or SoFar(next(_missing(seen, asked), ""))


def _ended(trace: Trace) -> SoFar:
    assert trace.exit is not None
    if trace.exit.code == 0:  # which may be just what was asked for
        return SoFar("the program has ended, with exit code 0")
    cause = causes.diagnose_process(trace)
    return _likely(cause) if cause is not None else SoFar()


def _likely(cause: Cause) -> SoFar:
    return SoFar(f"likely {cause}", likely=True)


def _causes(seen: Moment, asked: LiveView) -> Iterator[Cause]:
    """What may be the cause, the likeliest first."""
    trace, graph = seen.trace, seen.trace.graph
    silent = [topic for topic in _silent(seen) if topic not in seen.elsewhere]
    if (asleep := causes.diagnose_lifecycle(trace)) is not None:
        yield asleep
    for topic in silent:
        if any((each.topic, each.type) == (topic, seen.watched[topic]) for each in graph.publishers):
            if (unused := causes.diagnose_unused_publisher(trace, topic)) is not None:
                yield unused
        else:
            cause = causes.diagnose_no_messages(trace, topic, seen.watched[topic], answers=True)
            if cause.name in (names.WRONG_TYPE, names.WRONG_TOPIC):
                yield cause
    for wanted in asked.topics:
        for each in graph.subscriptions:
            if each.topic == wanted.name and each.type != wanted.type:
                yield Cause(names.WRONG_TYPE, f"{wanted.name} has the type {each.type}, not {wanted.type}", "")
    if not silent or not seen.watched:
        for miss in near_misses(graph, asked):
            yield Cause("wrong name", f"{miss.node} {miss.does} {miss.found}, not {miss.wanted}", "")
    if (mismatch := causes.diagnose_incompatible_service(graph.servers)) is not None:
        yield mismatch
    if (silent or seen.unanswered) and trace.sources and not source.calls(trace, *_SPINS):
        yield Cause(names.NO_SPIN, f"{_up(trace)}, and the program never calls rclpy.spin()", "")


def _missing(seen: Moment, asked: LiveView) -> Iterator[str]:
    """What did not come yet, what says most first; in each, too: where there is little room, the end is cut off."""
    trace, up = seen.trace, partial(_up, seen.trace)
    for topic in _silent(seen):
        there = any(each.topic == topic for each in trace.graph.publishers)
        yield f"{'nothing published' if there else 'no publisher'} on {topic} yet, {up()}"
    if seen.unanswered:
        yield f"no answer to a request yet, {up()}"
    graph = trace.graph
    offered = [each.name for each in graph.servers if not each.is_standard]
    lacking = [each for each in asked.services if not _is_there(each, offered)]
    if lacking and all(each.is_standard for each in graph.clients):
        yield f"no service {_listed(lacking) if offered else 'or client'} yet, {up()}"
    ends = [each.topic for each in (*graph.publishers, *graph.subscriptions)]
    for wanted in asked.topics:
        if not _is_there(wanted.name, ends):
            yield f"no publisher or subscription on {wanted.name} yet, {up()}"
    heard = [each.topic for each in graph.subscriptions if each.topic in [topic.name for topic in asked.topics]]
    if heard and not trace.logs:
        yield f"nothing logged yet, {up()} and subscribed to {heard[0]}"


def _is_there(wanted: str, found: Sequence[str]) -> bool:
    """Whether a name is among these, in whatever namespace: that may be just what was asked for."""
    return any(each.endswith(wanted) for each in found)


def _silent(seen: Moment) -> list[str]:
    return [topic for topic in seen.watched if not seen.trace.samples_on(topic)]


def _up(trace: Trace) -> str:
    nodes = list(dict.fromkeys(trace.graph.nodes))
    return f"{_listed(nodes)} {'is' if len(nodes) == 1 else 'are'} up"


def _listed(known: Sequence[str]) -> str:
    shown = [*known[:_MOST_NAMES], *([f"{len(known) - _MOST_NAMES} more"] if len(known) > _MOST_NAMES else [])]
    *most, last = shown
    return f"{', '.join(most)} and {last}" if most else last
