"""Forms about messages of a plain start: that they go on arriving, that echo shows them, how many, what is in them."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Topic
from tutor.exercise.publishing_start import NOT_STARTED, SLOW_SHARE, PublishingRun, PublishingStart
from tutor.exercise.seen_run import Seen, fits
from tutor.exercise.watched_start import Watching
from tutor.judge.bench import Run
from tutor.judge.check import Criterion
from tutor.judge.series import is_int_in_float
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Sample, Trace
from tutor.judge.verdict import Verdict, failed, passed, undecided
from tutor.judge.waiting_for_nodes import IDLE_S, IN_FLIGHT_S, wait_for_message
from tutor.judge.wording import counted, output_tail

SHOWN = 3
"""How many messages are shown as evidence."""

FASTER = "Publish from a timer that is fast enough, and let nothing hold it up."
"""The next step where messages come too seldom."""


def stopped(trace: Trace | None, topic: Topic) -> Observation:
    """The messages do not go on arriving."""
    return Symptom.NO_MESSAGES.seen(trace or NOT_STARTED, topic=topic.name, type=topic.type, some=True)


def wrong_value(trace: Trace, topic: Topic, sample: Sample, says: str, do: str) -> Observation:
    """A message has another value than it should; `do`: the next step, if there is a better one than to look."""
    do = do or f"Look at what the node puts into {topic.field} before it publishes."
    value = topic.value(sample)
    wrong = (value,) if is_int_in_float(value) else ()
    return Symptom.WRONG_VALUES.seen(trace, topic=topic.name, text=str(value), says=says, do=do, wrong=wrong)


@dataclass(frozen=True)
class Publishes(Form):
    """Messages of the topic's type go on arriving on it: one that is sent at the start is not enough.

    `at_least_hz`: how many must come in a second, on average and roughly: three quarters of it are enough.
    """

    topic: Topic
    at_least_hz: float = 0.0

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> PublishingStart:
        return PublishingStart(exercise.program, self.topic, self.at_least_hz)

    def judge(self, seen: PublishingRun) -> Verdict:
        """Judge a start without parameters."""
        topic = self.topic
        often = f", at least {self.at_least_hz:g} a second" if self.at_least_hz else ""
        expected = f"{topic.type} messages go on arriving on {topic.name}{often}"
        samples, began = seen.trace.samples_on(topic.name), seen.trace.started_at
        evidence = [topic.show(sample) for sample in samples[:1]]
        if seen.messages_go_on and seen.mean_hz < SLOW_SHARE * self.at_least_hz:
            if seen.slowed_below(self.at_least_hz):
                return undecided("to tell how often messages come")
            observed = f"{len(samples)} messages, {seen.mean_hz:.2g} a second"
            says = f"messages come on {topic.name}, and only {seen.mean_hz:.2g} a second"
            slow = Symptom.WRONG_RATE.seen(
                seen.trace, says=says, do=FASTER, wanted_hz=self.at_least_hz, found_hz=seen.mean_hz
            )
            return failed(expected, observed, slow, evidence)
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
        found = {
            endpoint.type for endpoint in (*graph.publishers, *graph.subscriptions) if endpoint.topic == topic.name
        }
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
        says = self.says or f"{wanted!r} is in no message, such as {topic.value(samples[0])!r}"
        other = wrong_value(seen.trace, topic, samples[0], says, self.do)
        return failed(expected, shown[0], other, shown)

    def _is_in(self, value: Any) -> bool:
        if isinstance(self.wanted, str):
            return self.wanted.casefold() in str(value).casefold()
        return bool(value == self.wanted)


@dataclass(frozen=True)
class WatchingMessages(Watching):
    """A criterion about the messages on a topic, judged on those of a time that begins with the first one."""

    topic: Topic

    @property
    def watched(self) -> dict[str, str]:
        return self.topic.watched

    async def watch(self, run: Run) -> bool:
        if not await wait_for_message(run, self.topic.name, self.topic.type):
            return False
        first, late_s = run.samples_on(self.topic.name)[0], run.our_cpu_wait_s() + run.node_cpu_wait_s()

        def is_over() -> bool:
            waited_s = run.our_cpu_wait_s() + run.node_cpu_wait_s() - late_s
            return run.now() >= first.source_time + self.within_s + IN_FLIGHT_S + waited_s

        await run.until(lambda: self.is_decided(run) or is_over(), self.within_s + 1.0, idle_s=IDLE_S)
        return True

    def judge_seen(self, seen: Seen) -> Verdict:
        samples = seen.trace.samples_on(self.topic.name)
        if not samples:
            missing = seen.symptom(Symptom.NO_MESSAGES, topic=self.topic.name, type=self.topic.type)
            return failed(self.expected, "no such message arrived", missing, output_tail(seen.trace))
        return self.judge_messages(seen, samples)

    @property
    @abstractmethod
    def expected(self) -> str:
        """What must be seen, in words."""

    @abstractmethod
    def is_decided(self, run: Run) -> bool:
        """Whether no later message can change the verdict."""

    @abstractmethod
    def judge_messages(self, seen: Seen, samples: Sequence[Sample]) -> Verdict:
        """Judge the messages; there is one at least."""


@dataclass(frozen=True)
class AtLeast(WatchingMessages):
    """At least this many messages arrive on a topic within a time, counted from the first one.

    `messages`: how many, the first one included. `within_s`: the time in seconds, to which a busy machine may add.
    A message or two that the node sends at once at its start may not reach anyone: ask for it of a topic that goes on.

        AtLeast("often", SCAN, 20, within_s=5)
    """

    messages: int

    @property
    def expected(self) -> str:
        return f"at least {self.messages} messages on {self.topic.name} within {self.within_s:g} s"

    def is_decided(self, run: Run) -> bool:
        return len(run.samples_on(self.topic.name)) >= self.messages

    def judge_messages(self, seen: Seen, samples: Sequence[Sample]) -> Verdict:
        limit_s = self.within_s + seen.cpu_wait_s
        counted_in = [sample for sample in samples if sample.source_time - samples[0].source_time <= limit_s]
        took_s = counted_in[-1].source_time - samples[0].source_time
        observed = f"{counted(len(counted_in), 'message')} in {max(took_s, 0.0):.1f} s"
        evidence = [self.topic.show(sample) for sample in counted_in[:SHOWN]]
        if len(counted_in) >= self.messages:
            return passed(self.expected, observed, evidence)
        few = seen.symptom(
            Symptom.NO_MESSAGES,
            topic=self.topic.name,
            type=self.topic.type,
            some=True,
            says=f"only {counted(len(counted_in), 'message')} came on {self.topic.name} within {self.within_s:g} s",
            do=FASTER,
        )
        return failed(self.expected, observed, few, evidence)


@dataclass(frozen=True)
class FieldEquals(WatchingMessages):
    """The topic's field has a value: in some message, or in every one.

    `wanted`: the value, or a function that says whether a value is right; then `what` says in words what it must be.
    A float is compared as nearly as 32 bits hold it. `every`: judge every message of the time `within_s`, in seconds
    from the first one on; otherwise, one within that time is enough. A single message can be every one: that they go on
    is for `Publishes` or `AtLeast`. `says` and `do`: what the learner is told.

        FieldEquals("even", COUNT, lambda count: count % 2 == 0, what="even", every=True)

    Raises ValueError for a function without `what`.
    """

    wanted: Any = field(hash=False)
    what: str = ""
    every: bool = False
    says: str = ""
    do: str = ""

    def __post_init__(self) -> None:
        if callable(self.wanted) and not self.what:
            raise ValueError(f"{self.id}: say in words what the value must be: what=...")

    @property
    def expected(self) -> str:
        some = "every message" if self.every else "a message"
        return f"{some} on {self.topic.name} has {self.what or repr(self.wanted)} in {self.topic.field}"

    def is_decided(self, run: Run) -> bool:
        return self._deciding(run.samples_on(self.topic.name)) is not None

    def judge_messages(self, seen: Seen, samples: Sequence[Sample]) -> Verdict:
        topic, deciding = self.topic, self._deciding(samples)
        shown, number = [topic.show(sample) for sample in samples[:SHOWN]], counted(len(samples), "message")
        if (deciding is not None) != self.every:
            return passed(self.expected, topic.show(deciding) if deciding else f"all of {number}", shown)
        other = deciding or samples[0]
        says = self.says or f"{topic.field} is {topic.value(other)!r}, not {self.what or repr(self.wanted)}"
        wrong = wrong_value(seen.trace, topic, other, says, self.do)
        return failed(self.expected, topic.show(other) if deciding else f"in none of {number}", wrong, shown)

    def _deciding(self, samples: Sequence[Sample]) -> Sample | None:
        """The first message that decides: one that is wrong, if every one must be right, or else one that is right."""
        return next((sample for sample in samples if self._is_right(self.topic.value(sample)) != self.every), None)

    def _is_right(self, value: Any) -> bool:
        return fits(self.wanted, value) and not is_int_in_float(value)
