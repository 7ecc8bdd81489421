"""A form: parameters that are set on the running node take effect."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tutor.exercise.form import Exercise, Form, parameter_node
from tutor.exercise.node_parameters import ParameterNode, fail_not_running, fail_not_set, is_unchanged
from tutor.exercise.nouns import Parameter, ShownIn, Value
from tutor.exercise.rate_at_run_time import RateAtRunTime, RateChanges
from tutor.exercise.run_time_changes import FAST_HZ, ChangeAtRunTime, RunTimeChanges
from tutor.judge.check import Criterion
from tutor.judge.rates import TOLERANCE, describe
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Sample, Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import counted, output_tail

MIN_BURST = 3
"""Messages in half a period that prove a backlog: without one, there are two at most, if the node publishes at once."""


@dataclass(frozen=True)
class SetAtRunTime(Form):
    """Setting a parameter on the running node takes effect within one period, and so does switching it off and on.

    `shown`: a parameter whose effect is ShownIn; `values`: two that it is set to, one after the other. `switch`: one
    whose effect is SwitchesOff. Nothing else may change: not the rate, and a rate that is set while the switch is off
    must not switch it on.
    """

    shown: Parameter
    values: tuple[Value, Value]
    switch: Parameter | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.shown.effect, ShownIn):
            raise ValueError(f"{self.id}: {self.shown.name} must have the effect ShownIn(topic)")

    def criterion(self, exercise: Exercise) -> Criterion:
        node, timer = parameter_node(exercise), exercise.first(RateAtRunTime)

        def judge(seen: RunTimeChanges, retimed: RateChanges | None) -> Verdict:
            others_ok = timer is None or retimed is None or timer.judge(retimed, node).passed
            return self.judge(seen, node, others_ok=others_ok)

        return self.judged(
            judge,
            ChangeAtRunTime(node, self.shown, *self.values, self.switch),
            exercise.scenario_of(timer),
            early=lambda seen: self.judge_changes(seen, node),
        )

    @property
    def _expected(self) -> str:
        names = f"{self.shown.name} and {self.switch.name}" if self.switch is not None else self.shown.name
        return f"setting {names} on the running node takes effect within one period"

    def _text(self, sample: Sample) -> str:
        assert self.shown.effect is not None
        return str(self.shown.effect.topic.value(sample))

    def _shows(self, value: Value, sample: Sample) -> bool:
        assert isinstance(self.shown.effect, ShownIn)
        return self.shown.effect.shows(value, sample)

    def judge(self, seen: RunTimeChanges, node: ParameterNode, *, others_ok: bool) -> Verdict:
        """Judge the changes.

        `others_ok`: whether changes of the rate pass. If a timer is left running whenever a parameter is set, it is up
        to their criterion to report that.
        """
        verdict = self.judge_changes(seen, node)
        if not verdict.passed or not others_ok or self.switch is None:
            return verdict
        if seen.sent_after_rate and node.rate is not None:
            number = counted(len(seen.sent_after_rate), "message")
            return failed(
                self._expected,
                f"{self.switch.name} set to false, then {node.rate.name} to {FAST_HZ}: {number}",
                _changed(seen.trace, node.rate, "restarts"),
                [self._text(sample) for sample in seen.sent_after_rate[:3]],
            )
        return self._fail_if_not_as_before(seen, self.switch, any_rate=False) or verdict

    def judge_changes(self, seen: RunTimeChanges, node: ParameterNode) -> Verdict:
        """Judge the changes, apart from a rate that differs afterwards: another criterion may show why."""
        expected, (value, _), switch, trace = self._expected, self.values, self.switch, seen.trace
        if seen.set_value is None:
            return fail_not_running(node, expected, trace, seen.stuck, seen.answering)
        for answer in (seen.set_value, seen.set_true, seen.set_off, seen.set_later, seen.set_on):
            if answer is not None and not (answer.answered and answer.successful):
                return fail_not_set(expected, answer, trace, seen.stuck)
        if not seen.went_on:
            return self._fail_silenced(seen)
        if seen.after_value is None:
            samples = trace.samples_on(node.topic.name)
            last = self._text(samples[-1]) if samples else "nothing"
            observed = f'{self.shown.name} set to {value}, but the messages still read "{last}"'
            return failed(expected, observed, _ignored(trace, self.shown))
        if switch is None:
            return passed(expected, f'"{self._text(seen.after_value)}"')
        if seen.sent_while_off:
            number = counted(len(seen.sent_while_off), "message")
            observed = f"{switch.name} set to false, but {number} more than a period later"
            shown = [self._text(sample) for sample in seen.sent_while_off[:3]]
            return failed(expected, observed, _ignored(trace, switch), shown)
        if seen.resumed is None:
            observed = f"{switch.name} set to false and to true again: no message since"
            return failed(expected, observed, _changed(trace, switch, "does not resume"))
        assert seen.set_on is not None
        return self._fail_if_not_as_before(seen, switch, any_rate=True) or passed(
            expected,
            f'"{self._text(seen.after_value)}"; silence while false; resumed '
            f"{seen.resumed.source_time - seen.set_on.asked_at:.2f} s after true",
        )

    def _fail_silenced(self, seen: RunTimeChanges) -> Verdict:
        """Fail a node that sends nothing more once its switch is set to true, which it was already."""
        changed, also = self.switch or self.shown, ""
        if self.switch is not None:
            also = f", and {self.switch.name} to true, which it was already"
        observed = f"{self.shown.name} set to {self.values[0]}{also}: no message since"
        how = "inverted" if seen.inverts else "stops"
        return failed(self._expected, observed, _changed(seen.trace, changed, how), output_tail(seen.trace))

    def _fail_if_not_as_before(self, seen: RunTimeChanges, switch: Parameter, *, any_rate: bool) -> Verdict | None:
        """Fail if messages after it is on again show the wrong value, or, unless `any_rate`, have the wrong rate.

        The right value is the one that was set in the meantime.
        """
        (value, later), trace, expected = self.values, seen.trace, self._expected
        actions = f"{self.shown.name} set to {later} while {switch.name} was false, then {switch.name} to true"
        texts = [self._text(sample) for sample in seen.after_resume]
        for sample in seen.after_resume:
            if not self._shows(later, sample):
                return failed(expected, f'{actions}: "{self._text(sample)}"', _ignored(trace, self.shown), texts)
        for sample in seen.after_resume:
            if self._shows(value, sample):
                both = _changed(trace, self.shown, "adds")
                return failed(expected, f'{actions}: "{self._text(sample)}"', both, texts)
        if texts and any_rate:
            return None
        burst = self._burst_on_resume(seen)
        if len(burst) >= MIN_BURST:
            return failed(
                expected, f"{actions}: {len(burst)} messages at once", _changed(trace, switch, "held back"), burst
            )
        if is_unchanged(seen.rate, seen.base_hz, at_start=seen.before):
            return None
        measured = describe(seen.rate, len(texts))
        observed = f"{actions}: {measured}, not {seen.base_hz:g} Hz ±{TOLERANCE:.0%} as before"
        if not texts:
            return failed(expected, observed, _changed(trace, switch, "does not resume"))
        changed = _changed(trace, switch, "rate changed", rate=seen.rate, wanted_hz=seen.base_hz)
        return failed(expected, observed, changed)

    def _burst_on_resume(self, seen: RunTimeChanges) -> list[str]:
        """The messages within half a period of the first one after the switch was set to true again."""
        assert seen.resumed is not None
        begin = seen.resumed.source_time
        hz = max(seen.base_hz, seen.before.hz if seen.before else 0.0)
        samples = seen.trace.samples_on(seen.resumed.topic)
        return [self._text(sample) for sample in samples if begin <= sample.source_time < begin + 0.5 / hz]


def _changed(trace: Trace, parameter: Parameter, how: str, **about: Any) -> Observation:
    """A change has an effect, but not the right one; `how` in words that mistakes of the catalogue know."""
    return Symptom.CHANGE_IGNORED.seen(trace, parameter=parameter.name, how=how, **about)


def _ignored(trace: Trace, parameter: Parameter) -> Observation:
    return Symptom.CHANGE_IGNORED.seen(trace, parameter=parameter.name)
