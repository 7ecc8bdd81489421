"""A form: the node receives the messages that we send, and shows each of them in its log or on another topic."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program, Topic, agrees
from tutor.exercise.seen_run import Seen, look, settle
from tutor.judge.bench import Bench, Run
from tutor.judge.check import Criterion
from tutor.judge.peers import Publisher
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Sample
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.waiting_for_nodes import RESENT_S, patience_s, wait_until_seen
from tutor.judge.wording import counted, output_tail
from tutor.ros_model import TopicEndpoint

SHOWN_TO = 0.01
"""How far a number in a log message may be rounded, relatively."""

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", re.IGNORECASE)
_DASH = re.compile(r"(?<=\w)-(?=\d)")


@dataclass(frozen=True)
class Reception(Seen):
    """What became of the messages that we sent, one after the other, until one was not shown.

    `subscribed`: whether the node had a subscription for them. `shown`: how they are shown, a line each.
    """

    subscribed: bool = True
    shown: tuple[str, ...] = ()
    ours: TopicEndpoint | None = None


async def wait_for_subscription(run: Run, topic: Topic, publisher: Publisher) -> bool:
    """Wait until a subscription of the node receives what we publish."""

    def subscriptions() -> list[tuple[str, str]]:
        return [(subscription.topic, subscription.type) for subscription in run.graph.subscriptions]

    matched = await wait_until_seen(
        run,
        lambda: publisher.subscribers > 0,
        promised=lambda: (topic.name, topic.type) in subscriptions(),
        message_gap_s=1.0,
        settle_s=lambda: patience_s(subscriptions(), topic.name, topic.type),
    )
    if matched:
        await settle(run)
    return matched


@dataclass(frozen=True)
class SendMessages:
    """Start without parameters, and send a message for each value, once the one before is shown.

    `values`: each with what the node makes of it.
    """

    program: Program
    topic: Topic
    values: tuple[tuple[Any, Any], ...]
    shown_on: Topic | None
    within_s: float

    async def __call__(self, bench: Bench) -> Reception:
        topic, shown = self.topic, list[str]()
        watched = self.shown_on.watched if self.shown_on is not None else {}
        async with (
            bench.start(self.program.file, watch=watched, expected_s=2.0) as run,
            run.publisher(topic.name, topic.type) as publisher,
        ):
            bench.report_progress(0.1, f"waiting for its subscription on {topic.name}")
            subscribed, ours = await wait_for_subscription(run, topic, publisher), publisher.endpoint
            for value, wanted in self.values if subscribed else ():
                bench.report_progress(0.4, f"sending {topic.field}: {value}")
                sent = publisher.publish(topic.message(value))
                if not await run.until(lambda: self._find(run, sent, wanted) != "", self.within_s, idle_s=RESENT_S):  # noqa: B023
                    break
                shown.append(self._find(run, sent, wanted))
            seen = await look(run, does_nothing=not shown)
            return seen.having(Reception, subscribed=subscribed, shown=tuple(shown), ours=ours)

    def _find(self, run: Run, sent: Sample, wanted: Any) -> str:
        """How a message is shown by now, or ""."""
        on = self.shown_on
        if on is None:
            return next((str(log) for log in run.logs if log.stamp >= sent.source_time and says(log.text, wanted)), "")
        samples = [sample for sample in run.samples_on(on.name) if sample.source_time >= sent.source_time]
        return next((f"{on.name}, {on.show(sample)}" for sample in samples if is_shown(on.value(sample), wanted)), "")


@dataclass(frozen=True)
class Receives(Form):
    """The node receives each message that we publish on its topic, and shows it: in its log, or on another topic.

    `values`: those of the topic's field, one message each, sent once a subscription is there and the one before is
    shown; take some that nothing else would show. `becomes`: what the node makes of a value, if that is another one.
    `shown_on`: the topic where it must then appear: a text as a part of its field, others as they are. Without it, some
    log message must contain it; a number may be rounded there. `within_s`: how long that may take, in seconds.

        Receives("doubles", COMMAND, (3, 21), becomes=lambda value: 2 * value, shown_on=RESULT)
    """

    topic: Topic
    values: tuple[Any, ...]
    becomes: Callable[[Any], Any] | None = None
    shown_on: Topic | None = None
    within_s: float = 3.0

    def criterion(self, exercise: Exercise) -> Criterion:
        scenario = SendMessages(exercise.program, self.topic, self._pairs, self.shown_on, self.within_s)
        return self.judged(self.judge, scenario)

    @property
    def _pairs(self) -> tuple[tuple[Any, Any], ...]:
        """Each value with what the node makes of it."""
        return tuple((value, self.becomes(value) if self.becomes else value) for value in self.values)

    def judge(self, found: Reception) -> Verdict:
        """Judge what became of the messages."""
        topic = self.topic
        place = self.shown_on.name if self.shown_on is not None else "its log"
        expected = f"each message on {topic.name} is shown within {self.within_s:g} s in {place}"
        about = {"topic": topic.name, "type": topic.type, "ours": found.ours}
        if not found.subscribed:
            unheard = found.symptom(Symptom.NOTHING_RECEIVED, **about)
            return failed(expected, f"no subscription on {topic.name}", unheard, output_tail(found.trace))
        if len(found.shown) == len(self.values):
            return passed(expected, counted(len(found.shown), "message"), found.shown)
        value, wanted = self._pairs[len(found.shown)]
        observed = f"{topic.field}: {value} was sent, and nothing shows {wanted!r} within {self.within_s:g} s"
        says = f"{value!r} on {topic.name} should show as {wanted!r} in {place}, and does not"
        do = f"Follow a message through the callback of {topic.name} to what it logs or publishes."
        unheard = found.symptom(Symptom.NOTHING_RECEIVED, says=says, do=do, **about)
        return failed(expected, observed, unheard, [*found.shown, *output_tail(found.trace)])


def is_shown(value: Any, wanted: Any) -> bool:
    """Whether a field shows what is wanted: a text as a part of it, anything else as it is."""
    return wanted in str(value) if isinstance(wanted, str) else agrees(value, wanted)


def says(text: str, wanted: Any) -> bool:
    """Whether a log message contains a text, whatever the case, or a number, which may be rounded.

    A dash right after a word may be a sign or not: "range-5" shows 5 as well as -5.
    """
    if isinstance(wanted, bool) or not isinstance(wanted, int | float):
        return str(wanted).casefold() in text.casefold()
    rounding = SHOWN_TO if isinstance(wanted, float) else 0.0
    numbers = [*_NUMBER.findall(text), *_NUMBER.findall(_DASH.sub(" ", text))]
    return any(math.isclose(float(number), wanted, rel_tol=rounding) for number in numbers)
