"""A form: some parameter, whose name is the learner's choice, sets the rate of a topic at start-up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Topic
from tutor.exercise.publishing_start import NOT_STARTED
from tutor.exercise.rate_probes import ProbeRates
from tutor.exercise.rate_units import (
    RateProbe,
    RateProbes,
    are_inverted,
    count_agreeing,
    find_agreeing_groups,
    find_inverted_probes,
    group_probes,
    has_known_unit,
)
from tutor.judge.check import Criterion
from tutor.judge.rates import TOLERANCE
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.ros_model import Parameter


@dataclass(frozen=True)
class RateAtStart(Form):
    """Some numeric parameter, set at start-up, changes the rate as its value says.

    Its name is the learner's choice: one that says rate, hz or frequency is read in Hz only; one that says period or
    interval in seconds or milliseconds; any other in any of these. Values that ask for 0.5 to 10 Hz are tried, one
    parameter at a time. `suggested`: the skeleton's name, tried where the node answers no parameter call.
    """

    topic: Topic
    suggested: str = "publish_rate"

    def scenario(self, exercise: Exercise) -> ProbeRates:
        """The starts with parameters."""
        return ProbeRates(exercise.program, self.topic, self.suggested)

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.scenario(exercise))

    def judge(self, found: RateProbes) -> Verdict:
        """Judge all starts that probed a rate."""
        expected = f"some numeric parameter, set at start-up, sets the rate (±{TOLERANCE:.0%})"
        for group in find_agreeing_groups(found.probes):
            observed = f"{group[0].name} is read in {group[0].unit}"
            return passed(expected, observed, [str(probe) for probe in group], spins=found.spins)
        if not found.probes:
            return failed(expected, "no numeric parameter is declared", self._not_declared(NOT_STARTED))
        declared = {parameter.name for parameter in found.declared or ()}

        def likelihood(group: Sequence[RateProbe]) -> tuple[bool, int, int, bool]:
            name, unit = group[0].key
            known = name in declared and has_known_unit(name)
            return known, count_agreeing(group), len(find_inverted_probes(group)), unit == "ms" and name.endswith("ms")

        nearest = max(group_probes(found.probes), key=likelihood)
        wrong = next((probe for probe in nearest if not probe.agrees), None)
        if wrong is None:
            narrow = Symptom.REFUSED.seen(
                nearest[0].trace,
                parameter=nearest[0].name,
                says=f"{nearest[0].name} takes only one of the rates that were tried",
                do="Let it take any rate from 0.5 to 10 Hz.",
            )
            return failed(expected, f"{nearest[0]}; no other value is allowed", narrow)
        why = self._wrong_rate(nearest, wrong, found.declared)
        return failed(expected, str(wrong), why, [str(probe) for probe in nearest])

    def _not_declared(self, trace: Trace) -> Observation:
        return Symptom.NOT_DECLARED.seen(trace, parameter=self.suggested, what="the rate", type="double")

    def _wrong_rate(
        self, group: Sequence[RateProbe], wrong: RateProbe, declared: tuple[Parameter, ...] | None
    ) -> Observation:
        """The rate differs from the one asked for; `group`: the probes that agree with each other best."""
        if declared is not None and wrong.name not in {parameter.name for parameter in declared}:
            return self._not_declared(wrong.trace)
        rates_hz = [probe.rate.hz for probe in group if probe.rate is not None]
        return Symptom.WRONG_RATE.seen(
            wrong.trace,
            topic=self.topic.name,
            type=self.topic.type,
            parameter=wrong.name,
            unit=wrong.unit,
            wanted_hz=wrong.asked_hz,
            rate=wrong.rate,
            inverted=are_inverted(group),
            unchanged=len(rates_hz) > 1 and max(rates_hz) <= min(rates_hz) * (1 + TOLERANCE),
            at_start=True,
        )
