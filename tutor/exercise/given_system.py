"""A system that is given: publishers of ours that are there before the learner's node, and what it logs of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_args

from tutor.exercise.node_parameters import DumpSilentNode
from tutor.exercise.nouns import Program, Topic
from tutor.exercise.receives import says
from tutor.exercise.seen_run import Seen, look, settle
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.peers import Offer
from tutor.judge.trace import Ending
from tutor.judge.waiting_for_nodes import RESENT_S, patience_s, wait_until_log_quiet, wait_until_seen
from tutor.ros_model import QoS, TopicEndpoint

SHOWN_WITHIN_S = 5.0
"""Time within which a message is logged, from when it was sent, or from when the message before it was logged."""

ALL_SHOWN_S = 20.0
"""Time within which all messages that were sent at once are logged."""

MATCH_GAP_S = 1.0
"""Time in which a subscription that is in the graph is matched, if its QoS allows that."""

QUIET_S, QUIET_MAX_S = 2.1, 3.0
"""How long nothing is logged once all has been said, and for how long that is waited for.

A timer that logs a message again every second or two shows in this time.
"""

LOST_AT_FIRST = 1
"""As many messages of a best-effort publisher may be lost before the first that is logged.

The node may not have discovered the publisher yet when the publisher has already discovered it.
"""

RELIABLE = QoS()
"""What a publisher with a plain depth offers: reliable and volatile."""

IN_A_ROW = 3
"""So many messages are sent at the publisher's own pace, whether they are shown or not."""

ROUNDS = 3
"""How often that is done, until all messages of a round are shown: a best-effort message may get lost."""

ROUND_S = 2.0
"""Time within which a round is shown; after the last one, it is SHOWN_WITHIN_S."""

LAST_LOGGED = 3
"""How many log messages are kept as evidence of what the node logged in place of a value."""

Sends = Literal["before", "one by one", "at once"]


@dataclass(frozen=True)
class GivenPublisher:
    """A publisher of ours that is there before the learner's node starts, and that the learner cannot change.

    `values`: returns those of the topic's field, one message each; draw them at random, so that nothing else would show
    them, all different, and none a part of another. `sends`: "before" the node starts, "one by one", each once the one
    before is shown, or all "at once". `every_s`: of those "one by one", the last nine are sent at this pace instead,
    in seconds, three in a row; three that are all shown are enough. `offers`: its QoS; it keeps as many messages as
    there are values. Raises ValueError for another word, if what is sent "before" is not kept (durability transient
    local), and for a pace of anything else than "one by one".

        MAP = GivenPublisher(Topic("/map", STRING), names, sends="before", offers=QoS(durability="transient_local"))
    """

    topic: Topic
    values: Callable[[], Sequence[Any]]
    sends: Sends = "one by one"
    offers: QoS = RELIABLE
    every_s: float = 0.0

    def __post_init__(self) -> None:
        if self.sends not in get_args(Sends):
            raise ValueError(f"{self.topic.name}: {self.sends!r} is no way to send: take {', '.join(get_args(Sends))}")
        if self.sends == "before" and self.offers.durability != "transient_local":
            raise ValueError(f"{self.topic.name}: what is sent before the node starts must be kept: transient_local")
        if self.every_s and self.sends != "one by one":
            raise ValueError(f"{self.topic.name}: only what is sent one by one may have a pace")

    def offer(self, values: Sequence[Any]) -> Offer:
        """The publisher as the bench makes it, with what it has published before the node starts."""
        topic, published = self.topic, values if self.sends == "before" else ()
        messages = tuple(topic.message(value) for value in published)
        return Offer(topic.name, topic.type, self.offers, len(values), messages)


@dataclass(frozen=True)
class Heard:
    """What became of the messages of one given publisher.

    `sent`: the values that were sent. `shown`: for each of these, the log messages that show it. `matched`: whether a
    subscription of the node was ever matched with it. `last_logged`: the newest log messages of the node when the wait
    for these was over.
    """

    ours: TopicEndpoint
    matched: bool = False
    sent: tuple[Any, ...] = ()
    shown: tuple[tuple[str, ...], ...] = ()
    last_logged: tuple[str, ...] = ()


@dataclass(frozen=True)
class SystemSeen(Seen):
    """What a node made of a given system, publisher by publisher, and how it ended on Ctrl+C."""

    heard: tuple[Heard, ...] = ()
    ending: Ending | None = None


class _Shown:
    """Which log messages show which of the values sent; it reads each log message once."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._read = 0
        self.sent: list[Any] = []
        self._shown: dict[Any, list[str]] = {}
        self._last_logged: tuple[str, ...] = ()

    def send(self, *values: Any) -> None:
        """Look for these values in what is logged from now on, too."""
        self.sent += values
        self._shown |= {value: [] for value in values}

    def of(self, value: Any) -> tuple[str, ...]:
        """The log messages that show a value, by now."""
        logs = self._run.logs
        for record in logs[self._read :]:
            for other, shown in self._shown.items():
                if says(record.text, other):
                    shown.append(str(record))
        self._read = len(logs)
        return tuple(self._shown[value])

    def count(self) -> int:
        """How many values are shown, by now."""
        return sum(bool(self.of(value)) for value in self.sent)

    def note_last_logged(self) -> None:
        """Keep the newest log messages: those of now, when the wait for the values is over."""
        self._last_logged = tuple(map(str, self._run.logs[-LAST_LOGGED:]))

    def heard(self, given: GivenPublisher) -> Heard:
        """What has become of all the messages of this publisher."""
        publisher, sent = self._run.offered(given.topic.name), tuple(self.sent)
        shown = tuple(map(self.of, sent))
        return Heard(publisher.endpoint, publisher.matches > 0, sent, shown, self._last_logged)


@dataclass(frozen=True)
class GivenSystem:
    """Start the node in a system of these publishers, which all send, one after the other; then press Ctrl+C."""

    program: Program
    publishers: tuple[GivenPublisher, ...]

    async def __call__(self, bench: Bench) -> SystemSeen:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> SystemSeen:
        drawn = [tuple(given.values()) for given in self.publishers]
        offers = [given.offer(values) for given, values in zip(self.publishers, drawn, strict=True)]
        async with bench.start(self.program.file, offers=offers, expected_s=4.0) as run:
            bench.report_progress(0.1, "waiting for its subscriptions")
            if await self._wait_for_subscriptions(run):
                await settle(run)
            ledgers = []
            for given, values in zip(self.publishers, drawn, strict=True):
                bench.report_progress(0.4, f"publishing on {given.topic.name}")
                ledgers.append(ledger := _Shown(run))
                await _SENDERS[given.sends](run, given, values, ledger)
                ledger.note_last_logged()
            await wait_until_log_quiet(run, quiet_s=QUIET_S, max_s=QUIET_MAX_S)
            heard = tuple(ledger.heard(given) for given, ledger in zip(self.publishers, ledgers, strict=True))
            silent = not all(all(part.shown) for part in heard)
            dump = DumpSilentNode(self.program)
            seen = await look(run, does_nothing=silent, dump=lambda: bench.facts(dump))
            bench.report_progress(0.9, "pressing Ctrl+C")
            return seen.having(SystemSeen, heard=heard, ending=await run.interrupt())

    async def _wait_for_subscriptions(self, run: Run) -> bool:
        """Wait until each publisher is matched with a subscription, but no longer than one may still come."""
        wanted = {(given.topic.name, given.topic.type) for given in self.publishers}

        def matched() -> set[str]:
            return {name for name, _ in wanted if run.offered(name).matches}

        def present() -> set[tuple[str, str]]:
            return {(subscription.topic, subscription.type) for subscription in run.graph.subscriptions}

        def patience() -> float:
            others = present() - wanted
            missing = [(name, type) for name, type in wanted - present() if name not in matched()]
            return max((patience_s(others, name, type) for name, type in missing), default=0.0)

        await wait_until_seen(
            run,
            lambda: len(matched()) == len(wanted),
            promised=lambda: wanted <= present() | {(name, type) for name, type in wanted if name in matched()},
            message_gap_s=MATCH_GAP_S,
            settle_s=patience,
        )
        return bool(matched())


async def _wait_for_kept(run: Run, given: GivenPublisher, values: tuple[Any, ...], ledger: _Shown) -> None:
    """Wait until what was published before the start is shown."""
    ledger.send(*values)
    if run.offered(given.topic.name).matches:
        await run.until(lambda: ledger.count() == len(values), SHOWN_WITHIN_S, idle_s=RESENT_S)


async def _send_one_by_one(run: Run, given: GivenPublisher, values: tuple[Any, ...], ledger: _Shown) -> None:
    """Send each value once the one before is shown, until one is not; then the rest, if there is a pace, at that."""
    publisher, lost = run.offered(given.topic.name), 0
    alone = max(0, len(values) - ROUNDS * IN_A_ROW) if given.every_s else len(values)
    for value in values[:alone]:
        ledger.send(value)
        publisher.publish(given.topic.message(value))
        if not publisher.subscribers:  # none that gets it
            break
        if await run.until(lambda: bool(ledger.of(value)), SHOWN_WITHIN_S, idle_s=RESENT_S):  # noqa: B023
            continue
        lost += 1
        if ledger.count() or lost > LOST_AT_FIRST or given.offers.reliability != "best_effort":
            break
        ledger.sent.remove(value)
    else:
        await _send_in_rounds(run, given, values[alone:], ledger)


async def _send_in_rounds(run: Run, given: GivenPublisher, values: tuple[Any, ...], ledger: _Shown) -> None:
    """Send these values at the publisher's pace, some in a row, until all of a row are shown.

    What is missing from a row does not count if there is another row, or if the machine may have kept the node from
    taking a message before the next one came: a queue of one message is enough.
    """
    publisher = run.offered(given.topic.name)
    for first in range(0, len(values), IN_A_ROW):
        row, last = values[first : first + IN_A_ROW], first + IN_A_ROW >= len(values)
        waited_s = run.node_cpu_wait_s()
        for value in row:
            ledger.send(value)
            publisher.publish(given.topic.message(value))
            next_at = run.now() + given.every_s
            await run.until(lambda: run.now() >= next_at, given.every_s)  # noqa: B023
        held_up = run.node_cpu_wait_s() - waited_s >= given.every_s / 2
        within_s = SHOWN_WITHIN_S if last else ROUND_S
        if await run.until(lambda: all(map(ledger.of, row)), within_s, idle_s=RESENT_S):  # noqa: B023
            return
        if held_up or not last:
            for value in row:
                if not ledger.of(value):
                    ledger.sent.remove(value)


async def _send_at_once(run: Run, given: GivenPublisher, values: tuple[Any, ...], ledger: _Shown) -> None:
    """Send all values at once, and wait as long as more of them are shown."""
    publisher, messages = run.offered(given.topic.name), [given.topic.message(value) for value in values]
    ledger.send(*values)
    for message in messages:
        publisher.publish(message)
    began, waited_s, shown = run.now(), run.node_cpu_wait_s(), -1

    def took_s() -> float:
        return run.now() - began - (run.node_cpu_wait_s() - waited_s)

    while publisher.subscribers and took_s() < ALL_SHOWN_S and shown < (shown := ledger.count()) < len(values):
        await run.until(lambda: ledger.count() > shown, SHOWN_WITHIN_S, idle_s=RESENT_S)


_SENDERS = {"before": _wait_for_kept, "one by one": _send_one_by_one, "at once": _send_at_once}
