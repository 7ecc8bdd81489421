"""Forms on what is logged of events that we make happen, judged on made-up facts: the door of a lift."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, cast

import pytest

from tests.checks.builders import (
    START,
    assert_failed,
    assert_passed,
    assert_undecided,
    ending,
    exited,
    graph,
    judge_of,
    lines,
    trace,
)
from tutor.exercise import EndsCleanly, Event, Feed, Form, LogsAt, Program, StaysQuiet, Throttles, Topic, check
from tutor.exercise.told_events import FeedRun, let_happen, tell
from tutor.judge.bench import Run
from tutor.judge.check import Check
from tutor.judge.peers import Publisher
from tutor.judge.trace import LogRecord, Sample
from tutor.judge.verdict import Verdict

LIFT = Program("lift.py")
DOOR = Topic("/door", "std_msgs/msg/Float64")
STAYS = Event("the door stays as it is", ({"data": 0.0},) * 3)
OPENS = Event("the door opens", ({"data": 0.43},), at="info")
BLOCKED = Event("the door is blocked", ({"data": 0.1},) * 100, at="warn")
FEED = Feed(DOOR, (STAYS, OPENS, OPENS, BLOCKED))

STARTS = (0.0, 1.0, 2.0, 3.0)
"""When the first message of each event was sent."""

SENT = tuple(
    (event, tuple(START + start + number / 20 for number in range(len(event.messages))))
    for event, start in zip(FEED.events, STARTS, strict=True)
)


def logged(at: float, level: int, text: str = "door") -> LogRecord:
    return LogRecord(level, "lift", text, START + at, START + at)


def ran(*logs: LogRecord, out: str = "") -> FeedRun:
    """A run in which all events happened, and this was logged."""
    seen = trace(graph=graph(), logs=logs)
    end = replace(ending(0), output=lines(out, "stdout"))
    return FeedRun(seen, told=tell(list(SENT), logs), ending=end)


def judged(form: Form, seen: FeedRun) -> tuple[Verdict, Check]:
    made = check("t1", LIFT, form)
    return judge_of(made, form.id)(seen), made


def test_all_events_of_a_feed_share_one_start_also_with_the_end() -> None:
    forms = (LogsAt("opens", FEED, OPENS.kind), StaysQuiet("quiet", FEED, STAYS.kind), EndsCleanly("end"))
    made = check("t1", LIFT, *forms)
    assert len({scenario for criterion in made.criteria for scenario in criterion.facts}) == 1


def test_what_is_logged_belongs_to_the_event_that_was_sent_last() -> None:
    first, second, third, _ = tell(list(SENT), (logged(0.5, 10), logged(1.0, 20), logged(2.9, 30)))
    assert [[log.level for log in told.logs] for told in (first, second, third)] == [[10], [20], [30]]
    assert tell([], (logged(0.5, 10),)) == ()


def test_events_of_another_kind_are_judged_as_well_and_named() -> None:
    form = LogsAt("opens", FEED, OPENS.kind, also=BLOCKED.kind)
    verdict, made = judged(form, ran(logged(1.0, 20), logged(2.0, 20)))
    assert_failed(verdict, "wrong level", f"{BLOCKED.kind} happens, and nothing is logged", check=made)
    verdict, made = judged(form, ran(logged(1.0, 20), logged(2.0, 20), logged(3.0, 20), logged(3.1, 20)))
    assert_failed(verdict, "logged too often", f"{BLOCKED.kind} is logged 2 times", check=made)
    assert_passed(judged(form, ran(logged(1.0, 20), logged(2.0, 20), logged(3.0, 20)))[0])


@dataclass
class Clockwork:
    """A run, and our publisher in it, whose time passes only while we wait."""

    due: tuple[LogRecord, ...]
    time: float = START
    exit: None = None

    @property
    def logs(self) -> tuple[LogRecord, ...]:
        return tuple(log for log in self.due if log.received_at <= self.time)

    def now(self) -> float:
        return self.time

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        end = self.time + limit_s
        while not seen() and self.time < end:
            self.time += 0.01
        return seen()

    def publish(self, message: Mapping[str, Any]) -> Sample:
        return Sample(DOOR.name, message, self.time, self.time)


def test_what_a_node_says_in_two_lines_is_of_one_event() -> None:
    run = Clockwork((logged(0.06, 20), logged(0.1, 20)))
    events = (OPENS, STAYS)

    async def happen() -> list[tuple[Event, tuple[float, ...]]]:
        return [(event, await let_happen(cast(Run, run), cast(Publisher, run), event)) for event in events]

    opens, stays = tell(asyncio.run(happen()), run.due)
    assert (len(opens.logs), stays.logs) == (2, ())


@pytest.mark.parametrize(
    ("logs", "cause", "words"),
    [
        ([logged(1.01, 20), logged(2.01, 20)], "", ""),
        ([logged(0.5, 20), logged(1.01, 20), logged(1.02, 10), logged(2.01, 20), logged(2.02, 30)], "", ""),
        ([logged(1.01, 20)], "wrong level", "nothing is logged at INFO"),
        ([], "wrong level", "nothing at INFO after 1 message with data: 0.43"),
        ([logged(1.01, 30), logged(2.01, 20)], "wrong level", "is logged at WARN instead of INFO"),
        ([logged(1.01, 20), logged(1.02, 20), logged(2.01, 20)], "logged too often", "is logged 2 times"),
    ],
)
def test_each_event_is_logged_once_at_its_level(logs: list[LogRecord], cause: str, words: str) -> None:
    verdict, made = judged(LogsAt("opens", FEED, OPENS.kind), ran(*logs))
    if cause:
        assert_failed(verdict, cause, words, check=made)
    else:
        assert_passed(verdict)


def test_a_text_may_have_to_show_what_was_sent_and_more_than_one_message_may_be_right() -> None:
    form = LogsAt("opens", FEED, OPENS.kind, at_most=2, shows=lambda text, sent: f"{sent['data']:.0%}" in text)
    good = [logged(at, 20, "open: 43%") for at in (1.01, 2.01)]
    assert_passed(judged(form, ran(*good))[0])
    assert_passed(judged(form, ran(*good, logged(2.02, 20, "opens")))[0])
    verdict, made = judged(form, ran(logged(1.01, 20, "opens")))
    assert_failed(verdict, "wrong level", "does not show what was received: 'opens'", check=made)
    verdict, made = judged(form, ran(logged(1.01, 10, "open: 43%")))
    assert_failed(verdict, "wrong level", "is logged at DEBUG instead of INFO", check=made)


def test_what_is_printed_in_place_of_a_log_message_is_told() -> None:
    verdict, made = judged(LogsAt("opens", FEED, OPENS.kind), FeedRun(trace(out="open"), told=tell(list(SENT), ())))
    assert_failed(verdict, "printed, not logged", check=made)


def test_an_event_may_leave_no_trace() -> None:
    form = StaysQuiet("quiet", FEED, STAYS.kind)
    assert_passed(judged(form, ran(logged(1.01, 20), logged(3.0, 30)))[0])
    verdict, made = judged(form, ran(logged(0.01, 20), logged(0.06, 20)))
    assert_failed(verdict, "logged too often", "2 log messages, the first at INFO", check=made)
    verdict, made = judged(form, replace(ran(out="0.43"), trace=trace(out="0.43")))
    assert_failed(verdict, "printed, not logged", check=made)


def test_what_may_be_logged_may_still_not_be_a_warning() -> None:
    form = StaysQuiet("quiet", FEED, STAYS.kind, calm=(OPENS.kind,))
    assert_passed(judged(form, ran(logged(-0.5, 20), logged(1.01, 20), logged(3.0, 30)))[0])
    verdict, made = judged(form, ran(logged(1.01, 20), logged(2.01, 20), logged(2.02, 30, "open again")))
    assert_failed(verdict, "logged too often", "no reason for a warning (the door opens)", "open again", check=made)
    verdict, made = judged(form, ran(logged(-0.5, 30, "no door yet"), logged(1.01, 20), logged(2.01, 20)))
    assert_failed(verdict, "logged too often", "before anything has happened", "no door yet", check=made)


def test_an_event_at_the_wrong_level_is_for_the_criterion_on_it() -> None:
    form = StaysQuiet("quiet", FEED, STAYS.kind, calm=(OPENS.kind,))
    assert_passed(judged(form, ran(logged(1.01, 20), logged(2.01, 30)))[0])


@pytest.mark.parametrize(
    ("at", "cause", "words"),
    [
        ((3.01, 5.02, 7.03), "", ""),
        ((3.5, 5.4, 7.3), "", ""),
        ((3.01, 5.9, 7.9), "", ""),
        ((), "wrong level", "nothing is logged at WARN"),
        ((3.01, 3.06, 3.11), "logged too often", "3 messages at WARN in 5.0 s, 0.05 s apart"),
        ((3.01, 4.6, 6.2), "logged too often", "1.6 s apart"),
        ((3.01,), "wrong level", "no message at WARN for 4.9 s"),
        ((3.01, 6.5), "wrong level", "no message at WARN for 3.5 s"),
        ((4.5, 6.5), "wrong level", "only 1.5 s after it has begun"),
    ],
)
def test_what_lasts_is_logged_again_and_again_but_not_too_often(at: tuple[float, ...], cause: str, words: str) -> None:
    logs = [logged(time, 30) for time in at]
    verdict, made = judged(Throttles("blocked", FEED, BLOCKED.kind, period_s=2.0), ran(*logs))
    if cause:
        assert_failed(verdict, cause, words, check=made)
    else:
        assert_passed(verdict)


def test_a_busy_machine_may_be_to_blame_for_a_late_message_and_so_may_our_own_delay() -> None:
    form = Throttles("blocked", FEED, BLOCKED.kind, period_s=2.0)
    late = ran(logged(3.01, 30), logged(6.5, 30))
    assert_undecided(judged(form, replace(late, slowed=True, cpu_wait_s=0.8))[0])
    paused = (BLOCKED, (*SENT[3][1][:10], *(sent + 2.0 for sent in SENT[3][1][50:])))  # none for 4 s
    told = tell([*SENT[:3], paused], (logged(3.01, 30), logged(7.6, 30), logged(9.7, 30)))
    assert_passed(judged(form, FeedRun(trace(), told=told))[0])


def test_a_node_that_does_not_listen_or_ends_is_told() -> None:
    form = LogsAt("opens", FEED, OPENS.kind)
    verdict, made = judged(form, FeedRun(trace(), subscribed=False))
    assert_failed(verdict, "no subscription", "no subscription on /door", check=made)
    crashed = FeedRun(trace(exit=exited(1)), told=tell(list(SENT[:1]), ()))
    verdict, made = judged(form, crashed)
    assert_failed(verdict, "exit at once", "while messages came on /door", check=made)


def test_an_unknown_level_or_event_is_the_authors_mistake() -> None:
    with pytest.raises(ValueError, match="'warning' is no level: take one of debug, info, warn, error, fatal"):
        Event("the door opens", (), at="warning")
    with pytest.raises(ValueError, match="opens: the feed has no event 'the door falls off'"):
        LogsAt("opens", FEED, "the door falls off")
    with pytest.raises(ValueError, match="quiet: the feed has no event 'the door falls off'"):
        StaysQuiet("quiet", FEED, STAYS.kind, calm=("the door falls off",))
