"""A form: in a system, what we send on one topic leads to a value on another."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from tutor.exercise.nouns import Topic
from tutor.exercise.seen_run import MATCH_S, fits
from tutor.exercise.system_run import Sent, SystemForm, SystemRun
from tutor.judge.bench import Run
from tutor.judge.trace import Sample
from tutor.judge.verdict import Verdict, failed, passed, undecided
from tutor.judge.waiting_for_nodes import SETTLE_S
from tutor.judge.wording import output_tail

PACE_SHARE = 1 / 3
"""By how much of it a steady change may differ."""

PACE_S = 0.8
"""Time over which the pace of a change is measured."""


@dataclass(frozen=True)
class LeadsTo(SystemForm):
    """A value that we send on one topic of a system leads to a value on another, through whatever nodes.

    `to`: the topic where it shows. `pairs`: the values to send, one after the other, each with the one that it must
    lead to. `within_s`: how long that may take, in seconds. `stays_s`: so many seconds later, and at the end, the value
    must still be there: where it changes steadily, it may otherwise just pass. `per_s`: where it must change steadily,
    by how much in a second; a third more or less is right. The exercise's program must be a `LaunchFile`:

        LeadsTo("tracks", TARGET, ANGLE, (("left", -1.0), ("right", 1.0)), within_s=2.0)
    """

    topic: Topic
    to: Topic
    pairs: tuple[tuple[Any, Any], ...]
    within_s: float = 3.0
    stays_s: float = 0.0
    per_s: float = 0.0

    @property
    def watched(self) -> tuple[Topic, ...]:
        return (self.to,)

    async def look(self, run: Run, sent: list[Sent]) -> None:
        topic = self.topic
        async with run.publisher(topic.name, topic.type) as publisher:
            # A system in which nobody listens gets the message all the same: why nothing follows is not ours to say.
            matched = await run.until(lambda: publisher.subscribers > 0, SETTLE_S)
            await run.until(lambda: bool(run.samples_on(self.to.name)), SETTLE_S if matched else MATCH_S)
            settled = run.now() + MATCH_S
            await run.until(lambda: run.now() >= settled, MATCH_S)
            for value, wanted in self.pairs:
                message = publisher.publish(topic.message(value))
                sent.append(Sent(topic.name, value, message.source_time))
                limit_s = (self.within_s if matched else MATCH_S) + self.stays_s
                if not await run.until(lambda: self._has_stayed(run, sent[-1], wanted), limit_s):  # noqa: B023
                    break

    def judge(self, seen: SystemRun) -> Verdict:
        topic, to = self.topic, self.to
        first, last = self.pairs[0], self.pairs[-1]
        expected = f"{first[0]!r} on {topic.name} leads to {first[1]} on {to.name} within {self.within_s:g} s"
        if last != first:
            expected += f", then {last[0]!r} to {last[1]}"
        shown: list[str] = []
        all_sent = [sent for sent in seen.sent if sent.topic == topic.name]
        ends = [*(sent.at for sent in all_sent[1:]), math.inf]
        for (value, wanted), sent, until in zip(self.pairs, all_sent, ends, strict=False):
            found = self._find(seen.trace, sent, wanted, until)
            took_s = found.source_time - sent.at if found is not None else 0.0
            if found is None or took_s > self.within_s:
                if seen.starved and not seen.broken and self._moves(seen, sent):
                    return undecided("to time what its nodes do")
                return self._failed(seen, expected, value, wanted, sent, shown)
            if self.per_s and (verdict := self._wrong_pace(seen, expected, sent, found)) is not None:
                return verdict
            shown.append(f"{value!r}: {to.show(found)} after {took_s:.1f} s")
        if len(shown) < len(self.pairs):  # the launch has ended before
            says = f"nothing takes what is sent on {topic.name}"
            return failed(expected, "the system was gone", seen.not_as_it_should(says), output_tail(seen.trace))
        return passed(expected, shown[-1], shown)

    def _failed(self, seen: SystemRun, expected: str, value: Any, wanted: Any, sent: Sent, shown: list[str]) -> Verdict:
        topic, to = self.topic, self.to
        later = [sample for sample in seen.trace.samples_on(to.name) if sample.source_time >= sent.at]
        reached = f"at the end, {to.show(later[-1])} on {to.name}" if later else f"no message came on {to.name}"
        observed = f"{value!r} was sent; {reached}"
        says = f"{value!r} on {topic.name} does not lead to {wanted} on {to.name} in time"
        in_time = (sample for sample in later if sample.source_time <= sent.at + self.within_s)
        if any(fits(wanted, to.value(sample)) for sample in in_time):
            says = f"{value!r} on {topic.name} leads to {wanted} on {to.name}, and then it goes on to another value"
        return failed(expected, observed, seen.not_as_it_should(says), [*shown, *output_tail(seen.trace)])

    def _wrong_pace(self, seen: SystemRun, expected: str, sent: Sent, found: Sample) -> Verdict | None:
        """The failure of a value that is there too early, or that changes slowly all the way; None if it is right."""
        on_way = [s for s in seen.trace.samples_on(self.to.name) if s.source_time <= found.source_time]
        start = self.to.value(next((s for s in reversed(on_way) if s.source_time < sent.at), on_way[0]))
        left = max((n for n, s in enumerate(on_way) if fits(start, self.to.value(s))), default=0)
        points = [(s.source_time, float(self.to.value(s))) for s in on_way[left:]]
        (began, first), (ended, last) = points[0], points[-1]
        if first == last:
            return None
        pace = abs(last - first) / max(ended - began, 1e-6)
        if pace <= (1 + PACE_SHARE) * self.per_s:
            moving = [(at, x) for at, x in points if not fits(x, first) and not fits(x, last)]
            long = [(b, a) for a, b in combinations(moving, 2) if b[0] - a[0] >= PACE_S]
            pace = max((abs(y - x) / (b - a) for (b, y), (a, x) in long), default=self.per_s)
            if pace >= (1 - PACE_SHARE) * self.per_s:
                return None
            if seen.starved and not seen.broken:
                return undecided("to time what its nodes do")
        says = f"{self.to.name} changes by {pace:.2g} in a second, and not by {self.per_s:g}"
        observed = f"from {first:.3g} to {last:.3g} in {ended - began:.1f} s"
        return failed(expected, observed, seen.not_as_it_should(says), output_tail(seen.trace))

    def _moves(self, seen: SystemRun, sent: Sent) -> bool:
        """Whether anything changed after a value was sent."""
        return len({str(self.to.value(s)) for s in seen.trace.samples_on(self.to.name) if s.source_time >= sent.at}) > 1

    def _has_stayed(self, run: Run, sent: Sent, wanted: Any) -> bool:
        found = self._find(run, sent, wanted)
        return found is not None and run.now() >= found.source_time + self.stays_s

    def _find(self, seen: Any, sent: Sent, wanted: Any, until: float = math.inf) -> Sample | None:
        """The first message that shows the value after another was sent, if it has come, and the value has stayed.

        `until`: when the next value was sent. Whether messages keep coming is not asked.
        """
        after = [sample for sample in seen.samples_on(self.to.name) if sent.at <= sample.source_time < until]
        shows = [sample for sample in after if fits(wanted, self.to.value(sample))]
        if not shows:
            return None
        stays = shows[-1] is after[-1] or shows[-1].source_time >= shows[0].source_time + self.stays_s
        leaves = self.stays_s and shows[-1].source_time < after[-1].source_time - self.stays_s
        return shows[0] if stays and not leaves else None
