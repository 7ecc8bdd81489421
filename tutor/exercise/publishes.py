"""Forms about messages of a plain start: that they go on arriving, that echo shows them, what is in them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Topic
from tutor.exercise.publishing import NOT_STARTED, PublishingRun, PublishingStart
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import output_tail


def stopped(trace: Trace | None, topic: Topic) -> Observation:
    """The messages do not go on arriving."""
    return Symptom.NO_MESSAGES.seen(trace or NOT_STARTED, topic=topic.name, type=topic.type, some=True)


@dataclass(frozen=True)
class Publishes(Form):
    """Messages of the topic's type go on arriving on it: one that is sent at the start is not enough."""

    topic: Topic

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> PublishingStart:
        return PublishingStart(exercise.program, self.topic)

    def judge(self, seen: PublishingRun) -> Verdict:
        """Judge a start without parameters."""
        topic = self.topic
        expected = f"{topic.type} messages go on arriving on {topic.name}"
        samples, began = seen.trace.samples_on(topic.name), seen.trace.started_at
        evidence = [topic.show(sample) for sample in samples[:1]]
        if seen.messages_go_on:
            observed = f"{len(samples)} messages, the first {samples[0].received_at - began:.2f} s after the start"
            return passed(expected, observed, evidence)
        observed = "no such message arrived"
        if samples:
            number = f"{len(samples)} messages" if len(samples) > 1 else "one message"
            observed = f"{number} until {samples[-1].received_at - began:.1f} s after the start, then no more"
        missing = Symptom.NO_MESSAGES.seen(
            seen.trace,
            stuck=seen.stuck,
            answers=seen.parameters is not None,
            topic=topic.name,
            type=topic.type,
            some=bool(samples),
        )
        return failed(expected, observed, missing, [*evidence, *output_tail(seen.trace)])


@dataclass(frozen=True)
class ShownByEcho(Form):
    """An independent subscriber that picks its QoS as `ros2 topic echo` does gets the messages."""

    topic: Topic

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, PublishingStart(exercise.program, self.topic))

    def judge(self, seen: PublishingRun) -> Verdict:
        """Judge a start without parameters, in which echo looked at the topic."""
        topic = self.topic
        expected = f"`ros2 topic echo {topic.name}` shows the values"
        echo = seen.echo
        if echo is None:
            return failed(expected, "messages do not go on arriving", stopped(seen.trace, topic))
        # A subscription counts, too: the real echo takes the type from all that is on the topic, and refuses two.
        graph = seen.trace.graph
        found = {each.type for each in (*graph.publishers, *graph.subscriptions) if each.topic == topic.name}
        if len(types := sorted(found.union(echo.types))) > 1:
            mixed = Symptom.NO_MESSAGES.seen(seen.trace, topic=topic.name, type=topic.type, types=tuple(types))
            return failed(expected, "refused, since there is more than one type on the topic", mixed)
        if echo.samples:
            shown = f"shown with {echo.qos.reliability}, {echo.qos.durability} QoS"
            return passed(expected, shown, [topic.show(echo.samples[0])])
        unheard = Symptom.NO_MESSAGES.seen(
            seen.trace, topic=topic.name, type=topic.type, some=True, qos=str(echo.qos), gone=not echo.types
        )
        return failed(expected, f"nothing shown in {echo.limit_s:g} s", unheard)


@dataclass(frozen=True)
class Contains(Form):
    """A message has a certain content, soon after a start without parameters.

    `wanted`: of a text, a part of it, whatever the case; of anything else, the value itself. `says` and `do`: what the
    learner is told where it is missing, if a message without it says more than that.
    """

    topic: Topic
    wanted: Any
    says: str = ""
    do: str = ""

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> PublishingStart:
        return PublishingStart(exercise.program, self.topic)

    def judge(self, seen: PublishingRun) -> Verdict:
        """Judge a start without parameters."""
        topic, wanted = self.topic, self.wanted
        expected = f"a message on {topic.name} with {wanted!r} in {topic.field}"
        samples = seen.trace.samples_on(topic.name)
        if not samples:
            return Publishes(self.id, topic).judge(seen)
        found = next((sample for sample in samples if self._is_in(topic.value(sample))), None)
        if found is not None:
            return passed(expected, topic.show(found))
        shown = [topic.show(sample) for sample in samples[:3]]
        other = Symptom.WRONG_VALUES.seen(
            seen.trace,
            topic=topic.name,
            text=str(topic.value(samples[0])),
            says=self.says or f"{wanted!r} is in no message, such as {topic.value(samples[0])!r}",
            do=self.do or f"Look at what the node puts into {topic.field} before it publishes.",
        )
        return failed(expected, shown[0], other, shown)

    def _is_in(self, value: Any) -> bool:
        if isinstance(self.wanted, str):
            return self.wanted.casefold() in str(value).casefold()
        return bool(value == self.wanted)
