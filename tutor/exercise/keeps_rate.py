"""A form: in a system, messages keep coming at a rate, whatever else its nodes do."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from tutor.exercise.nouns import Topic
from tutor.exercise.system_run import Sent, SystemForm, SystemRun
from tutor.judge.bench import Run
from tutor.judge.rates import FAR_ABOVE, are_even, describe, measure
from tutor.judge.verdict import Verdict, failed, passed, undecided
from tutor.judge.waiting_for_nodes import IN_FLIGHT_S, SETTLE_S, window_s
from tutor.judge.wording import output_tail

GAP_PERIODS = 3.0
"""A gap of more than so many periods, the topic's own and those that it should have, is a pause."""

GAP_S = 0.8
"""No shorter gap is a pause: a machine may delay a message by this much."""


@dataclass(frozen=True)
class KeepsRate(SystemForm):
    """Messages keep coming on a topic of a system, at this rate and without a pause, from its start to the last look.

    That is as long as other criteria of the exercise make it work. `hz`: the rate. The exercise's program must be a
    `LaunchFile`:

        KeepsRate("scan", SCAN, 5.0)
    """

    topic: Topic
    hz: float

    @property
    def watched(self) -> tuple[Topic, ...]:
        return (self.topic,)

    async def look(self, run: Run, sent: list[Sent]) -> None:
        name = self.topic.name
        if await run.until(lambda: bool(run.samples_on(name)), SETTLE_S):
            until = run.now() + window_s(self.hz) + 0.5 / self.hz + IN_FLIGHT_S
            await run.until(lambda: run.now() >= until, until - run.now())

    def judge(self, seen: SystemRun) -> Verdict:
        topic, hz = self.topic, self.hz
        expected = f"messages on {topic.name} keep coming at {hz:g} Hz"
        samples = [sample for sample in seen.trace.samples_on(topic.name) if sample.source_time >= seen.seen_from]
        shown = [topic.show(sample) for sample in samples[-1:]]
        times = [*sorted(sample.source_time for sample in samples), seen.seen_until]
        late_s = times[0] - (seen.seen_from + GAP_S)  # a node needs a moment until it is heard
        times = [seen.seen_from + GAP_S, *times] if late_s > 0 else times
        gap_s, until_end_s = max((b - a for a, b in pairwise(times)), default=0.0), times[-1] - times[-2:][0]
        rate = measure(samples)
        usual_s = rate.median_s if rate is not None and rate.median_s is not None else 0.0
        excess_s = gap_s - max(GAP_PERIODS / hz, GAP_S, GAP_PERIODS * usual_s)
        observed, says = describe(rate, len(samples)), f"{topic.name} does not have the rate that it should have"
        if not samples:
            says = f"no message of its type comes on {topic.name}"
        elif excess_s > 0:
            if gap_s == until_end_s:
                observed += f", and none in the last {gap_s:.1f} s"
                says = f"the messages on {topic.name} stop coming"
            elif gap_s == late_s:
                observed += f", and none in the first {gap_s + GAP_S:.1f} s"
                says = f"the messages on {topic.name} begin late"
            else:
                observed += f", with a pause of {gap_s:.1f} s"
                says = f"the messages on {topic.name} stop for a while"
        elif rate is not None and rate.agrees_with(hz):
            return passed(expected, observed, shown)
        too_often = rate is not None and rate.hz > FAR_ABOVE * hz  # the machine is never to blame for that
        sure = not seen.starved or too_often or are_even(samples) or excess_s > seen.cpu_wait_s or not samples
        if not sure and not seen.broken:
            return undecided("to measure the rates of its nodes")
        return failed(expected, observed, seen.not_as_it_should(says), [*shown, *output_tail(seen.trace)])
