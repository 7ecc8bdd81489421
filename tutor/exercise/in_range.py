"""Forms about the values of a topic: that they are in its range, and that they vary at random."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tutor.exercise.collected_values import (
    MAX_COLLECT_S,
    MIN_VALUES,
    CollectedValues,
    CollectMoreValues,
    CollectValues,
    find_out_of_range,
)
from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Topic
from tutor.exercise.publishes import stopped
from tutor.exercise.publishing_start import NOT_STARTED
from tutor.exercise.rate_at_start import RateAtStart
from tutor.judge import randomness
from tutor.judge.check import Criterion
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Verdict, failed, passed


def _collect(exercise: Exercise, topic: Topic) -> CollectValues:
    """The starts that collect values, helped by those that probe the rate, if the exercise has them."""
    rate = exercise.first(RateAtStart, lambda form: form.topic == topic)
    return CollectValues(exercise.program, topic, rate.scenario(exercise) if rate is not None else None)


@dataclass(frozen=True)
class OtherUnit:
    """A unit that may be taken for the right one, and the range in it of values that are meant to be right."""

    name: str
    low: float
    high: float

    def fits(self, values: Sequence[float]) -> bool:
        """Whether all values may be in this unit."""
        return all(self.low <= value <= self.high for value in values)


@dataclass(frozen=True)
class InRange(Form):
    """Every value is in the topic's range, both ends included; judged without parameters.

    `other_units`: those in which a learner may have given all values. Raises ValueError for a topic without a range.
    """

    topic: Topic
    other_units: tuple[OtherUnit, ...] = ()

    def __post_init__(self) -> None:
        if self.topic.low is None or self.topic.high is None:
            raise ValueError(f"{self.id}: {self.topic.name} has no range, give it `low` and `high`")

    def criterion(self, exercise: Exercise) -> Criterion:
        values = _collect(exercise, self.topic)
        return self.judged(self.judge, values, CollectMoreValues(values), early=self.judge_so_far)

    def judge(self, found: CollectedValues, more: CollectedValues) -> Verdict:
        """Judge the values of all starts without parameters."""
        topic = self.topic
        unit = f" {topic.unit}" if topic.unit else ""
        expected = f"every value in [{topic.low}, {topic.high}]{unit}"
        if not found.all:
            return failed(expected, "no values at all", stopped(found.trace, topic))
        values = (*found.all, *more.all)
        wrong = find_out_of_range(values, topic)
        if not wrong:
            return passed(expected, f"{len(values)} values from {min(values):.2f} to {max(values):.2f}{unit}")
        seen = Symptom.WRONG_VALUES.seen(
            found.trace or NOT_STARTED,
            topic=topic.name,
            wrong=tuple(wrong),
            lowest=topic.low,
            highest=topic.high,
            other_unit=next((other.name for other in self.other_units if other.fits(values)), ""),
        )
        observed = f"{len(wrong)} of {len(values)} values outside, such as {wrong[0]:g}"
        return failed(expected, observed, seen, [f"{topic.field}: {value!r}" for value in wrong[:5]])

    def judge_so_far(self, found: CollectedValues) -> Verdict | None:
        """Judge by the values so far; None while a few do not yet show whether all are in another unit."""
        if len(found.all) < MIN_VALUES and any(other.fits(found.all) for other in self.other_units):
            return None
        return self.judge(found, CollectedValues(()))


@dataclass(frozen=True)
class Varies(Form):
    """The values vary as random ones do: not constant, not a ramp, not a short cycle; judged without parameters."""

    topic: Topic

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, _collect(exercise, self.topic))

    def judge(self, found: CollectedValues) -> Verdict:
        """Judge the values of the starts that collect them."""
        topic = self.topic
        expected = "values that vary at random: not constant, not a ramp, not a short cycle"
        runs = (*found.runs, found.regular)
        patterns = [(run, pattern) for run in runs if (pattern := _find_pattern(run)) is not None]
        large_enough = sum(len(run) >= randomness.MIN_SAMPLE_SIZE for run in found.runs)
        if patterns and (any(pattern.significant for _, pattern in patterns) or len(patterns) >= large_enough):
            run, pattern = max(patterns, key=lambda found: (found[1].significant, len(found[0])))
            return failed(
                expected,
                f"{pattern.text} ({len(run)} values)",
                Symptom.WRONG_VALUES.seen(found.trace or NOT_STARTED, topic=topic.name, pattern=pattern, drawn=run),
                [f"{topic.field}: {value:g}" for value in run[:8]],
            )
        longest = max(found.runs, key=len)
        if len(longest) < MIN_VALUES:
            return failed(expected, f"only {len(longest)} values in {MAX_COLLECT_S:g} s", stopped(found.trace, topic))
        shown = [f"{topic.field}: {value:g}" for value in longest[:5]]
        return passed(expected, f"{len(longest)} values, no pattern", shown)


def _find_pattern(run: Sequence[float]) -> randomness.Pattern | None:
    """Find a pattern in these values; getting stuck on one value takes precedence over any other."""
    found, stuck = randomness.find_pattern(run), _find_stuck_value(run)
    return replace(stuck, significant=found is not None and found.significant) if stuck else found


def _find_stuck_value(run: Sequence[float]) -> randomness.Pattern | None:
    """Find a run of distinct values followed by a new one that repeats for at least half of `FULL_SAMPLE_SIZE`.

    It must be new: in coarsely rounded values that are mostly one number, that number occurs earlier as well.
    """
    repeats = next((i for i, value in enumerate(reversed(run)) if value != run[-1]), len(run))
    before = run[: len(run) - repeats]
    if repeats < randomness.FULL_SAMPLE_SIZE / 2 or len(before) < 2 or len({*before, run[-1]}) <= len(before):
        return None
    return randomness.Pattern("constant value", f"the last {repeats} values are all {run[-1]:g}")
