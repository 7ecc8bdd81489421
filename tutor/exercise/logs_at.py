"""Forms: what happens is logged at its level, as often as it should be, and nothing else is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.told_events import SHOWN_S, Feed, FeedRun, LetHappen, Told
from tutor.judge.bench import Scenario
from tutor.judge.check import Criterion
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Level, LogRecord
from tutor.judge.verdict import Verdict, failed, passed, undecided
from tutor.judge.wording import counted, output_tail

EARLY_SHARE = 0.9
"""A throttle may be that much of its period early: clocks are read at different times."""

LATE_S = 1.0
"""How much later than after its period the next throttled message may come."""

_EVIDENCE = 5


@dataclass(frozen=True)
class FeedForm(Form, ABC):
    """A criterion on the events of a kind in a feed."""

    feed: Feed
    kind: str

    def __post_init__(self) -> None:
        for kind in self.kinds:
            self.require(kind)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of events that are judged."""
        return (self.kind,)

    def require(self, kind: str) -> None:
        """Raise ValueError unless the feed has an event of this kind."""
        if not any(event.kind == kind for event in self.feed.events):
            raise ValueError(f"{self.id}: the feed has no event {kind!r}")

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, LetHappen(exercise.program, self.feed))

    def ended_start(self, exercise: Exercise) -> Scenario[Any] | None:
        return None if self.feed.log_level else LetHappen(exercise.program, self.feed)

    def judge(self, found: FeedRun) -> Verdict:
        """Judge what was logged."""
        topic = self.feed.topic
        if not found.subscribed:
            about = {"topic": topic.name, "type": topic.type, "ours": found.ours}
            unheard = found.symptom(Symptom.NOTHING_RECEIVED, **about)
            return failed(self.expected, f"no subscription on {topic.name}", unheard, output_tail(found.trace))
        events = [told for told in found.told if told.event.kind in self.kinds]
        happened = sum(event.kind in self.kinds for event in self.feed.events)
        if len(events) < happened and found.trace.exit is not None:
            ended = found.symptom(Symptom.ENDED)
            observed = f"it ended by itself ({found.trace.exit}) while messages came on {topic.name}"
            return failed(self.expected, observed, ended, output_tail(found.trace))
        return self.judge_events(found, events)

    @property
    @abstractmethod
    def expected(self) -> str:
        """What must be seen, in words."""

    @abstractmethod
    def judge_events(self, found: FeedRun, events: list[Told]) -> Verdict:
        """Judge the events, all of which happened."""

    @property
    def level(self) -> Level:
        """The level at which they must be logged."""
        return next(event.level or Level.DEBUG for event in self.feed.events if event.kind == self.kind)

    def wrong(self, found: FeedRun, told: Told, observed: str, *, says: str, do: str, **about: Any) -> Verdict:
        """The failure of an event that is not logged at its level."""
        prints_only = not found.trace.logs
        missing = found.symptom(
            Symptom.WRONG_LEVEL,
            says=says,
            do=do,
            what=told.event.kind,
            recognise=(lambda text: True) if prints_only else None,
            event=told,
            wanted=self.level,
            lowest_level=min((log.level for log in found.trace.logs), default=Level.FATAL),
            earlier=[log for one in found.of(told.event.kind) if one.sent < told.sent for log in one.at(self.level)],
            **about,
        )
        printed = [line.text for line in found.printed[:_EVIDENCE]] if prints_only else []
        return failed(self.expected, observed, missing, _shown(told.logs) or printed)

    def too_much(self, found: FeedRun, logs: list[LogRecord], observed: str, **words: str) -> Verdict:
        """The failure of a node that logs more than it should: `says`, `do`, and `what`, if it is not `kind`."""
        about = {"what": self.kind, **words, "logged": tuple(logs)}
        flooded = found.symptom(Symptom.LOGGED_TOO_OFTEN, **about)
        return failed(self.expected, observed, flooded, _shown(logs))


@dataclass(frozen=True)
class LogsAt(FeedForm):
    """Each event of a kind is logged at its level: once, however many messages it has.

    `feed`: what happens, event by event, while the node runs. `kind`: that of the events that are judged. `at_most`:
    how many messages at that level each of them may have, if more than one is right; 0 for any number. `shows`: whether
    a log message shows what was sent, given its text and the fields of the event's first message; without it, any text
    will do. `also`: another kind that is judged in the same way, and named where it is not logged.

        OPENS = Event("the door opens", ({"data": True},), at="info")
        LogsAt("opens", Feed(DOOR, (OPENS,)), "the door opens")
    """

    at_most: int = 1
    shows: Callable[[str, Mapping[str, Any]], bool] | None = None
    also: str = ""

    @property
    def kinds(self) -> tuple[str, ...]:
        return (self.kind, self.also) if self.also else (self.kind,)

    @property
    def expected(self) -> str:
        times = {0: "at least one message", 1: "one message"}.get(self.at_most, f"1 to {self.at_most} messages")
        return f"{self.kind}: {times} at {self.level.name}, within {SHOWN_S:g} s"

    def judge_events(self, found: FeedRun, events: list[Told]) -> Verdict:
        shown: list[LogRecord] = []
        for told in events:
            logs = told.at(self.level)
            if not any(self._is_shown(log, told) for log in logs):
                return self._missing(found, told)
            if 0 < self.at_most < len(logs):
                observed = f"{counted(len(logs), 'message')} at {self.level.name} for one event, {_sent(told)}"
                says = f"{told.event.kind} is logged {len(logs)} times, so that what matters drowns in repetition"
                do = "Log it when it begins: remember in the node what the last message said, and compare."
                if len({log.text for log in logs}) == len(logs) == 2:
                    do = "Say in one message all that is to be said of it."
                return self.too_much(found, logs, observed, says=says, do=do, what=told.event.kind)
            shown += logs
        return passed(self.expected, f"{counted(len(events), 'event')}, each at {self.level.name}", _shown(shown))

    def _is_shown(self, log: LogRecord, told: Told) -> bool:
        return self.shows is None or self.shows(log.text, told.event.messages[0])

    def _missing(self, found: FeedRun, told: Told) -> Verdict:
        level, others = self.level.name, [log for log in told.logs if self._is_shown(log, told)]
        if told.at(self.level):
            says = f"what is logged at {level} does not show what was received: {told.at(self.level)[0].text!r}"
            do = "Put the values of the message into the text."
            return self.wrong(found, told, str(told.at(self.level)[0]), says=says, do=do)
        if others:
            says = f"{told.event.kind} is logged at {Level(others[0].level).name} instead of {level}"
            return self.wrong(found, told, str(others[0]), says=says, do=f"Use the logger's method for {level}.")
        says = f"{told.event.kind} happens, and nothing is logged at {level}"
        do = f"Find the place in the callback where it is noticed, and log it there at {level}."
        observed = f"nothing at {level} after {_sent(told)}"
        return self.wrong(found, told, observed, says=says, do=do)


@dataclass(frozen=True)
class StaysQuiet(FeedForm):
    """Nothing at all is logged for events of a kind, and the program prints nothing in the whole run.

    `feed`: what happens, event by event, while the node runs. `kind`: that of the events that are judged. `calm`: the
    kinds of events that may be logged, but not as a warning or worse; nor may there be a warning before all events.

        STAYS = Event("the door stays closed", ({"data": False},) * 4)
        StaysQuiet("quiet", Feed(DOOR, (STAYS,)), "the door stays closed")
    """

    calm: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        for kind in self.calm:
            self.require(kind)

    @property
    def expected(self) -> str:
        return f"{self.kind}: nothing in the log, and nothing printed"

    def judge_events(self, found: FeedRun, events: list[Told]) -> Verdict:
        logs = [log for told in events for log in told.logs]
        if logs:
            level = Level(logs[0].level).name if logs[0].level in set(Level) else str(logs[0].level)
            observed = f"{counted(len(logs), 'log message')}, the first at {level}, after {_sent(events[0])}"
            says = f"{self.kind} is logged at {level}, which is shown by default"
            do = "Ask who must read this at night; what nobody must is for a lower level."
            return self.too_much(found, logs, observed, says=says, do=do)
        # An event that is logged at another level than it should be is for the criterion on it.
        at_level = [told for told in found.told if told.event.level is None or told.at(told.event.level)]
        for told in (told for told in at_level if told.event.kind in self.calm):
            if loud := [log for log in told.logs if log.level >= Level.WARN]:
                says = f"there is no reason for a warning ({told.event.kind}), and this comes: {loud[0]}"
                do = "Warn only as long as there is something to warn of; that all is well is for INFO."
                return self.too_much(found, loud, f"{loud[0]}, after {_sent(told)}", says=says, do=do)
        began = found.told[0].sent[0]
        if self.calm and (loud := [log for log in found.trace.logs if log.level >= Level.WARN and log.stamp < began]):
            says = f"there is a warning before anything has happened: {loud[0]}"
            return self.too_much(found, loud, f"{loud[0]}, at the start", says=says, do="Say how it begins at INFO.")
        if printed := [line.text for line in found.printed]:
            symptom = found.symptom(
                Symptom.NOT_LOGGED,
                what="something",
                recognise=lambda text: text in printed,
                says=f"{printed[0]!r} is printed: it has no level, so that nobody can switch it off",
                do="Log it with the node's own logger, at the level that it deserves.",
            )
            return failed(self.expected, f"{counted(len(printed), 'line')} printed", symptom, printed[:_EVIDENCE])
        return passed(self.expected, f"{counted(sum(len(told.sent) for told in events), 'message')} sent, none logged")


@dataclass(frozen=True)
class Throttles(FeedForm):
    """While an event of a kind lasts, it is logged at once, and then again and again, but not too often.

    `feed`: what happens, event by event, while the node runs. `kind`: that of the events that are judged, whose
    messages should come for more than twice as long as `period_s`: at most one log message comes in that time, in
    seconds, and the next soon after it.

        IS_OPEN = Event("the door is open", ({"data": True},) * 100, at="warn")
        Throttles("open", Feed(DOOR, (IS_OPEN,)), "the door is open")
    """

    period_s: float = 2.0

    @property
    def expected(self) -> str:
        return f"{self.kind}: at {self.level.name} at once, then once in {self.period_s:g} s while it lasts"

    def judge_events(self, found: FeedRun, events: list[Told]) -> Verdict:
        shown: list[LogRecord] = []
        for told in events:
            verdict = self._judge_event(found, told)
            if verdict is not None:
                return verdict
            shown += told.at(self.level)
        lasted_s = sum(told.sent[-1] - told.sent[0] for told in events)
        return passed(self.expected, f"{counted(len(shown), 'message')} in {lasted_s:.1f} s", _shown(shown))

    def _judge_event(self, found: FeedRun, told: Told) -> Verdict | None:
        level, logs = self.level.name, told.at(self.level)
        if not logs:
            says = f"{self.kind}, {_sent(told)}, and nothing is logged at {level}"
            if told.logs:
                says = f"{self.kind} is logged at {Level(told.logs[0].level).name} instead of {level}"
            do = f"Log it at {level}, with a limit on how often."
            return self.wrong(found, told, f"nothing at {level} after {_sent(told)}", says=says, do=do)
        stamps = [log.stamp for log in logs]
        gaps = [later - earlier for earlier, later in pairwise(stamps)]
        if gaps and min(gaps) < EARLY_SHARE * self.period_s:
            lasted_s = told.sent[-1] - told.sent[0]
            observed = f"{counted(len(logs), 'message')} at {level} in {lasted_s:.1f} s, {min(gaps):.2g} s apart"
            says = f"while {self.kind}, {counted(len(logs), 'message')} came in {lasted_s:.1f} s, and hide all others"
            do = f"Let the line that logs it speak at most once in {self.period_s:g} s."
            return self.too_much(found, logs, observed, says=says, do=do)
        waits = [stamps[0] - told.sent[0], *self._late(told, stamps)]
        if max(waits) <= LATE_S:
            return None
        if max(waits) <= LATE_S + found.cpu_wait_s:
            return undecided("to tell whether the node is late")
        if max(waits) == waits[0]:
            observed = f"the first message at {level} {waits[0]:.1f} s after the first of {_sent(told)}"
            says = f"{self.kind} is logged at {level} only {waits[0]:.1f} s after it has begun"
        else:
            last_s = max(waits) + self.period_s
            observed = f"no message at {level} for {last_s:.1f} s, though {_sent(told)} came"
            says = f"{self.kind} is logged, but then it goes on, and nothing says so for {last_s:.1f} s"
        do = f"Log it each time it is noticed, and let the throttle drop what comes within {self.period_s:g} s."
        return self.wrong(found, told, observed, says=says, do=do, too_few=True)

    def _late(self, told: Told, stamps: list[float]) -> Iterator[float]:
        """How long after the first message of ours that was due for it each further log message came, in seconds.

        The last one may not have come at all: then, how long we have sent messages in vain.
        """
        for stamp, following in zip_longest(stamps, stamps[1:], fillvalue=told.sent[-1]):
            due = next((sent for sent in told.sent if sent >= stamp + self.period_s), None)
            if due is not None:
                yield following - due


def _sent(told: Told) -> str:
    """What was sent, in words: "12 messages with percentage: 0.12"."""
    first = ", ".join(f"{name}: {value:.4g}" for name, value in told.event.messages[0].items())
    return f"{counted(len(told.sent), 'message')} with {first}"


def _shown(logs: tuple[LogRecord, ...] | list[LogRecord]) -> list[str]:
    return [str(log) for log in logs[:_EVIDENCE]]
