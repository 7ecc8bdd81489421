"""Events that we make happen on a topic, and the start of a node that should log each of them at its level."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from tutor.exercise.nouns import Program, Topic
from tutor.exercise.receives import wait_for_subscription
from tutor.exercise.seen_run import Seen, look
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.peers import Publisher
from tutor.judge.trace import Ending, Level, LogRecord, OutputLine
from tutor.judge.waiting_for_nodes import HARDLY_WAITED_SHARE, IN_FLIGHT_S, RESENT_S
from tutor.ros_model import TopicEndpoint

SHOWN_S = 3.0
"""How long it may take until an event is in the log, in seconds."""

QUIET_S = 0.5
"""How long we wait after an event that is not to be logged: what a node says of it nevertheless comes in this time."""

GAP_S = 0.05
"""Time between two messages, in seconds."""


@dataclass(frozen=True)
class Event:
    """Something that happens on a topic: messages of ours, sent one after the other.

    `kind`: what it is called in a report, such as "a change of status"; criteria name the kind that they judge.
    `messages`: their fields and values; fields that are not named have their defaults. `at`: the level at which the
    node must log it, "debug" to "fatal", or "" if it must not. Raises ValueError for an unknown level.
    """

    kind: str
    messages: tuple[Mapping[str, Any], ...] = field(hash=False)
    at: str = ""

    def __post_init__(self) -> None:
        if self.at and self.at.upper() not in Level.__members__:
            names = ", ".join(level.name.lower() for level in Level)
            raise ValueError(f"{self.kind}: {self.at!r} is no level: take one of {names}, or none")

    @property
    def level(self) -> Level | None:
        """Its level; None if it must not be logged."""
        return Level[self.at.upper()] if self.at else None


@dataclass(frozen=True)
class Feed:
    """What happens on a topic in one start of the node, event by event.

    `log_level`: start the node with `--log-level` and this; without it, as it is.
    """

    topic: Topic
    events: tuple[Event, ...]
    log_level: str = ""


@dataclass(frozen=True)
class Told:
    """What the node logged from the first message of an event to that of the next. `sent`: when each was sent."""

    event: Event
    sent: tuple[float, ...]
    logs: tuple[LogRecord, ...]

    def at(self, level: Level) -> list[LogRecord]:
        """The messages at exactly this level."""
        return [log for log in self.logs if log.level == level]


@dataclass(frozen=True)
class FeedRun(Seen):
    """A start in which the events of a feed happened, ended with Ctrl+C.

    `subscribed`: whether the node had a subscription for them. `told`: the events that happened, with what was logged.
    `ending`: None if the process had ended before Ctrl+C.
    """

    subscribed: bool = True
    ours: TopicEndpoint | None = None
    told: tuple[Told, ...] = ()
    ending: Ending | None = None

    def of(self, kind: str) -> list[Told]:
        """The events of a kind, in their order."""
        return [told for told in self.told if told.event.kind == kind]

    @property
    def printed(self) -> list[OutputLine]:
        """What the program wrote to its standard output; log messages go to the other stream."""
        lines = (*self.trace.output, *(self.ending.output if self.ending is not None else ()))
        return [line for line in lines if line.stream == "stdout" and line.text.strip()]


@dataclass(frozen=True)
class LetHappen:
    """Start the node, let the events of a feed happen, and press Ctrl+C."""

    program: Program
    feed: Feed

    async def __call__(self, bench: Bench) -> FeedRun:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> FeedRun:
        topic, happened = self.feed.topic, list[tuple[Event, tuple[float, ...]]]()
        messages = sum(len(event.messages) for event in self.feed.events)
        async with (
            bench.start(self.program.file, log_level=self.feed.log_level, expected_s=3.0 + 2 * GAP_S * messages) as run,
            run.publisher(topic.name, topic.type) as publisher,
        ):
            bench.report_progress(0.1, f"waiting for its subscription on {topic.name}")
            subscribed, ours = await wait_for_subscription(run, topic, publisher), publisher.endpoint
            since, waited_s = run.now(), run.our_cpu_wait_s()
            for number, event in enumerate(self.feed.events if subscribed else ()):
                bench.report_progress(0.2 + 0.6 * number / len(self.feed.events), f"{event.kind} on {topic.name}")
                happened.append((event, await let_happen(run, publisher, event)))
                if run.exit is not None:
                    break
            delayed = run.our_cpu_wait_s() - waited_s > HARDLY_WAITED_SHARE * (run.now() - since)
            seen = await look(run, does_nothing=not run.logs)
            bench.report_progress(0.9, "pressing Ctrl+C")
            ending = await run.interrupt() if not seen.stuck else None
            told = tell(happened, seen.trace.logs)
            found = seen.having(FeedRun, subscribed=subscribed, ours=ours, told=told, ending=ending)
            return FeedRun(**{**vars(found), "slowed": found.slowed or delayed})


async def let_happen(run: Run, publisher: Publisher, event: Event) -> tuple[float, ...]:
    """Send the messages of an event, and wait until it is logged; return when each of them was sent.

    What else the node says of it comes soon after the first line, or when the machine lets it go on.
    """
    sent: list[float] = []
    for message in event.messages:
        sent.append(publisher.publish(message).source_time)
        until = run.now() + GAP_S
        await run.until(lambda: run.now() >= until, GAP_S)  # noqa: B023
    level = event.level
    if level is None:
        await run.until(lambda: run.exit is not None, QUIET_S, idle_s=RESENT_S)
    else:
        await run.until(
            lambda: any(log.level >= level and log.stamp >= sent[0] for log in run.logs), SHOWN_S, idle_s=RESENT_S
        )
        await run.until(lambda: run.exit is not None, IN_FLIGHT_S)
    return tuple(sent)


def tell(happened: list[tuple[Event, tuple[float, ...]]], logs: tuple[LogRecord, ...]) -> tuple[Told, ...]:
    """Each event with what was logged from its first message to that of the next event."""
    ends = [*(sent[0] for _, sent in happened), float("inf")][1:]
    return tuple(
        Told(event, sent, tuple(log for log in logs if sent[0] <= log.stamp < end))
        for (event, sent), end in zip(happened, ends, strict=True)
    )
