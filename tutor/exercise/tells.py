"""A form: in a system, one topic tells in words what another topic is about."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from tutor.exercise.nouns import Topic
from tutor.exercise.system_run import Sent, SystemForm, SystemRun
from tutor.judge.bench import Run
from tutor.judge.trace import Sample
from tutor.judge.verdict import Verdict, failed, passed, undecided
from tutor.judge.waiting_for_nodes import SETTLE_S
from tutor.judge.wording import output_tail


@dataclass(frozen=True)
class Tells(SystemForm):
    """In a system, each text on one topic has in it what another topic says at that time.

    `topic`: the topic with the texts. `of`: the topic that it tells of. `agrees`: whether a text agrees with a value of
    that topic. `all_of`: what must have been told at the end: what shows that changes are told, too. `lag_s`: by how
    much a text may be behind; `within_s`: how long it may take until all has been told; `goes_on_s`: how much longer it
    is looked at, so that what is told only once shows; all in seconds. The exercise's program must be a `LaunchFile`:

        Tells("warns", STATE, LEVEL, lambda text, level: ("full" in text) == (level > 9), ("filling", "full"))
    """

    topic: Topic
    of: Topic
    agrees: Callable[[str, Any], bool] = field(hash=False)
    all_of: tuple[str, ...] = ()
    lag_s: float = 1.0
    within_s: float = 10.0
    goes_on_s: float = 0.0

    @property
    def watched(self) -> tuple[Topic, ...]:
        return (self.topic, self.of)

    async def look(self, run: Run, sent: list[Sent]) -> None:
        both = (self.topic.name, self.of.name)
        if await run.until(lambda: all(run.samples_on(name) for name in both), SETTLE_S):
            await run.until(lambda: self._told_all(run) or self._silence(run) is not None, self.within_s)
            until = run.now() + self.goes_on_s
            await run.until(lambda: run.now() >= until, self.goes_on_s)

    def judge(self, seen: SystemRun) -> Verdict:
        topic, of, trace = self.topic, self.of, seen.trace
        wanted = ", then ".join(map(repr, self.all_of))
        expected = f"{topic.name} tells what {of.name} says" + (f": {wanted}" if wanted else "")
        texts, values = trace.samples_on(topic.name), trace.samples_on(of.name)
        shown = [topic.show(sample) for sample in texts[-3:]]
        if not texts or not values:
            silent = topic.name if not texts else of.name
            why = seen.not_as_it_should(f"no message of its type comes on {silent}")
            return failed(expected, f"no message on {silent}", why, [*shown, *output_tail(trace)])
        wrong = self._find_wrong(texts, values, self.lag_s)
        if wrong is not None:
            text, value = wrong
            if seen.starved and not seen.broken and self._find_wrong(texts, values, math.inf) is None:
                return undecided("to tell late messages from wrong ones")
            observed = f"{topic.show(text)}, when {of.name} had {of.show(value)}"
            why = seen.not_as_it_should(f"{topic.name} says something else than {of.name}")
            return failed(expected, observed, why, [*shown, *output_tail(trace)])
        missing = [part for part in self.all_of if not any(part in str(topic.value(text)) for text in texts)]
        if missing and seen.starved and not seen.broken:
            return undecided("to see what its nodes tell")
        if missing:
            observed = f"{missing[0]!r} is in none of {len(texts)} messages on {topic.name}"
            why = seen.not_as_it_should(f"{topic.name} never says {missing[0]!r}")
            return failed(expected, observed, why, [*shown, *output_tail(trace)])
        return passed(expected, f"{len(texts)} messages on {topic.name} agree with {of.name}", shown)

    def _find_wrong(
        self, texts: Sequence[Sample], values: Sequence[Sample], lag_s: float
    ) -> tuple[Sample, Sample] | None:
        """The first text that says something else than the values of its time, with the last of these."""
        for text in texts:
            before = [value for value in values if value.source_time <= text.source_time]
            if not before or before[0].source_time > text.source_time - self.lag_s:
                continue  # it may not have heard of any value yet
            old = [value for value in before if value.source_time < text.source_time - lag_s]
            recent = [*old[-1:], *before[len(old) :]]
            told = str(self.topic.value(text))
            if not any(self.agrees(told, self.of.value(value)) for value in recent):
                return text, recent[-1]
        return None

    def _told_all(self, run: Run) -> bool:
        told = self.topic.values(run)
        return all(any(part in str(text) for text in told) for part in self.all_of)

    def _silence(self, run: Run) -> Sample | None:
        """The last value of the other topic, once none has come for so long that nothing more will be told."""
        last = run.samples_on(self.of.name)[-1]
        return last if run.now() - last.received_at > SETTLE_S else None
