"""Form: each message says in its header when it was made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tutor.exercise.publishes import SHOWN, WatchingMessages, wrong_value
from tutor.exercise.seen_run import Seen
from tutor.judge.bench import Run
from tutor.judge.trace import Sample
from tutor.judge.verdict import Verdict, failed, passed, undecided
from tutor.judge.wording import counted

NOW_S = 0.5
"""How far a stamp may be from the time at which its message is sent, in seconds, if the machine is not busy."""

_DAY_S = 86400.0


@dataclass(frozen=True)
class Stamped(WatchingMessages):
    """The topic's field, a time, is in every message the time at which it is sent, to within half a second.

    The messages of the time `within_s` are judged, in seconds from the first one on: a stamp that is taken once grows
    old in it. `topic`: its `field` is a builtin_interfaces/Time.

        Stamped("stamped", Topic("/scan", "sensor_msgs/msg/LaserScan", "header.stamp"), within_s=2.0)
    """

    @property
    def expected(self) -> str:
        return f"every message on {self.topic.name} has the time of now in {self.topic.field}"

    def is_decided(self, run: Run) -> bool:
        return self._is_wrong(run.samples_on(self.topic.name), run.node_cpu_wait_s())

    def judge_messages(self, seen: Seen, samples: Sequence[Sample]) -> Verdict:
        worst = max(samples, key=lambda sample: abs(self._age_s(sample)))
        age_s, shown = self._age_s(worst), [self._show(sample) for sample in samples[:SHOWN]]
        if abs(age_s) <= NOW_S:
            return passed(self.expected, f"all of {counted(len(samples), 'message')}", shown)
        if not self._is_wrong(samples, seen.cpu_wait_s):
            return undecided("to tell whether a stamp is old")
        says = f"{self.topic.field} is not the time of now"
        if abs(age_s) < _DAY_S:
            side = "before" if age_s > 0 else "after"
            says += f", but {abs(age_s):.1f} s {side} the message is sent"
        do = "Take the time from the node's clock each time you fill in a message."
        wrong = wrong_value(seen.trace, self.topic, worst, says, do)
        return failed(self.expected, self._show(worst), wrong, dict.fromkeys([*shown, self._show(worst)]))

    def _is_wrong(self, samples: Sequence[Sample], cpu_wait_s: float) -> bool:
        """Whether stamps are wrong by more than can be due to waits for a CPU between taking a stamp and sending it.

        Such waits make stamps old, never early, and no wait can make several messages late: their ages add up.
        """
        ages_s = [age_s for sample in samples if abs(age_s := self._age_s(sample)) > NOW_S]
        return min(ages_s, default=0.0) < 0 or sum(ages_s) > NOW_S + cpu_wait_s

    def _stamp_s(self, sample: Sample) -> float:
        stamp: Any = self.topic.value(sample)
        return float(stamp["sec"] + stamp["nanosec"] / 1e9)

    def _age_s(self, sample: Sample) -> float:
        """How old the stamp was when the message was sent, in seconds; below 0 if it was still to come."""
        return sample.source_time - self._stamp_s(sample)

    def _show(self, sample: Sample) -> str:
        return f"{self.topic.field}: {self._stamp_s(sample):.3f} s, sent at {sample.source_time:.3f} s"
