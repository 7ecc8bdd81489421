"""Forms about bad values of parameters on the running node: they are rejected, and change nothing."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise.bad_values import AtomicRequests, BadValues, SetAtomically, SetBadValues
from tutor.exercise.form import Exercise, Form, parameter_node
from tutor.exercise.node_parameters import ParameterNode, describe_refusal, fail_not_running, fail_not_set, is_unchanged
from tutor.exercise.nouns import Parameter, SetsRate, ShownIn, Value, show
from tutor.exercise.rate_at_run_time import RateAtRunTime, RateChanges
from tutor.exercise.run_time_changes import RunTimeChanges
from tutor.exercise.set_at_run_time import SetAtRunTime
from tutor.judge import tracebacks
from tutor.judge.check import Criterion
from tutor.judge.parameter_answers import is_from_rclpy
from tutor.judge.rates import Rate, describe
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.verdict import Verdict, failed, passed, skipped
from tutor.judge.wording import output_tail


@dataclass(frozen=True)
class Rejects(Form):
    """Bad values are rejected with a reason; the value stays, and so does the rate.

    `bad`: the values. `while_at`: of a parameter that sets the rate, a good rate in Hz, other than the default, at
    which the node publishes when it is asked, so that a fallback to the default shows. At 3 Hz, a forgotten timer of
    1 Hz shows as well.
    """

    parameter: Parameter
    bad: tuple[Value, ...]
    while_at: float | None = None

    def criterion(self, exercise: Exercise) -> Criterion:
        node = parameter_node(exercise)
        from_hz = self.while_at if isinstance(self.parameter.effect, SetsRate) else None
        return self.judged(
            lambda seen, changed: self.judge(seen, node, exercise, changed.before if changed else None),
            SetBadValues(node, self.parameter, self.bad, from_hz),
            exercise.scenario_of(exercise.first(SetAtRunTime)),
            early=self.judge_so_far,
        )

    def judge(self, seen: BadValues, node: ParameterNode, exercise: Exercise, at_start: Rate | None) -> Verdict:
        """Judge the answers, and the rate afterwards; `at_start`: the rate of another start without parameters."""
        expected = self._expected(seen)
        if not seen.rejected:
            return fail_not_running(node, expected, seen.trace, seen.stuck, seen.answering)
        if (accepted := self._fail_if_not_refused(seen, expected)) is not None:
            return accepted
        if seen.set_good is not None:
            timer = exercise.first(RateAtRunTime)
            see = f": see `{timer.id}`" if timer is not None else ""
            return skipped(f"not judged, because {describe_refusal(seen.set_good)}{see}")
        if not is_unchanged(seen.rate, seen.base_hz, at_start=at_start, before=seen.rate_before):
            observed = f"after the rejection: {describe(seen.rate, seen.messages)}"
            return failed(expected, observed, _rate_changed(self.parameter, seen.trace, seen.rate))
        return passed(expected, f'rejected: "{seen.rejected[0][0].reason}"; still {seen.rate}')

    def judge_so_far(self, seen: BadValues) -> Verdict:
        """Judge by the answers so far."""
        expected = self._expected(seen)
        return self._fail_if_not_refused(seen, expected) or passed(expected, "so far")

    def _expected(self, seen: BadValues) -> str:
        values = " and ".join(show(bad) for bad in self.bad)
        return (
            f"{self.parameter.name} {values} are rejected with a reason; "
            f"the value and the rate stay at {seen.base_hz} Hz"
        )

    def _fail_if_not_refused(self, seen: BadValues, expected: str) -> Verdict | None:
        """Fail if one of the answers to bad values is wrong."""
        name = self.parameter.name
        for answer, value in seen.rejected:
            bad = answer.values[name]
            if not answer.answered:
                crashed = _fail_if_crashed(self.parameter, answer, expected, seen.trace)
                return crashed or fail_not_set(expected, answer, seen.trace, seen.stuck)
            if answer.successful:
                return failed(expected, f"{name} {bad} was accepted", _accepted(self.parameter, seen.trace, answer))
            if not answer.reason.strip():
                mute = Symptom.BAD_VALUE_ACCEPTED.seen(seen.trace, parameter=name, answer=answer, reason="")
                return failed(expected, f"{bad} was rejected without a reason", mute)
            if is_from_rclpy(answer.reason):
                return fail_not_set(expected, answer, seen.trace, seen.stuck)
            if value != seen.before:
                observed = f"{bad} was rejected, but {name} is {show(value)} now"
                return failed(expected, observed, _taken_over(self.parameter, seen.trace, "the value changes"))
        return None


@dataclass(frozen=True)
class RejectsAtomically(Form):
    """One atomic set of a good and a bad value, in either order, changes nothing at all.

    Judged only where an atomic set of good values is accepted. `shown`: a parameter whose effect is ShownIn, and
    `tokens`: three values that are to be recognised in messages. `bad` and `good`: values of `other`.
    """

    shown: Parameter
    tokens: tuple[Value, Value, Value]
    other: Parameter
    bad: Value
    good: Value

    def __post_init__(self) -> None:
        if not isinstance(self.shown.effect, ShownIn):
            raise ValueError(f"{self.id}: {self.shown.name} must have the effect ShownIn(topic)")

    def criterion(self, exercise: Exercise) -> Criterion:
        node = parameter_node(exercise)
        scenario = SetAtomically(node, self.shown, self.tokens, self.other, self.bad, self.good)
        changes, timer = exercise.first(SetAtRunTime), exercise.first(RateAtRunTime)

        def judge(seen: AtomicRequests, changed: RunTimeChanges | None, retimed: RateChanges | None) -> Verdict:
            first = retimed.steps[0][0] if retimed is not None and retimed.steps else None
            answers = ((changes, changed.set_value if changed else None), (timer, first))
            alone = [form.id for form, answer in answers if form and answer and not answer.successful]
            return self.judge(seen, node, changed.before if changed else None, alone)

        return self.judged(judge, scenario, exercise.scenario_of(changes), exercise.scenario_of(timer))

    def judge(self, seen: AtomicRequests, node: ParameterNode, at_start: Rate | None, alone: list[str]) -> Verdict:
        """Judge both requests.

        `at_start`: the rate of another start without parameters. `alone`: the criteria in which a good value alone is
        refused.
        """
        shown, other, trace = self.shown, self.other, seen.trace
        expected = (
            f"an atomic set of a good {shown.name} and a bad {other.name}, in either order, changes nothing at all"
        )
        if not seen.answers:
            return fail_not_running(node, expected, trace, seen.stuck, seen.answering)
        if seen.set_good is not None and seen.set_good.answered and not seen.set_good.successful:
            see = f": see `{alone[0]}`" if alone else ""
            return skipped(f"not judged, because {describe_refusal(seen.set_good)}{see}")
        for answer in seen.answers:
            if not answer.answered:
                crashed = _fail_if_crashed(other, answer, expected, trace)
                return crashed or fail_not_set(expected, answer, trace, seen.stuck)
        for answer in seen.answers:
            if answer.successful:
                return failed(expected, "the request was accepted", _accepted(other, trace, answer))
        changed = next((held for held in seen.values if held != seen.before), None)
        if changed is not None or seen.shown is not None:
            assert shown.effect is not None
            now = f"{shown.name}, {other.name} are {changed}"
            if seen.shown is not None:
                now = f'a message reads "{shown.effect.topic.value(seen.shown)}"'
            partly = _taken_over(other, trace, "applies a part of the request")
            return failed(expected, f"rejected, but {now}", partly)
        if not is_unchanged(seen.rate, seen.base_hz, at_start=at_start):
            observed = f"rejected, but then {describe(seen.rate, seen.messages)}"
            return failed(expected, observed, _rate_changed(other, trace, seen.rate))
        return passed(expected, f'both rejected ("{seen.answers[0].reason}"), nothing changed')


def _fail_if_crashed(parameter: Parameter, answer: SetAnswer, expected: str, trace: Trace) -> Verdict | None:
    """Fail a node that crashed because it accepted a bad rate and created a timer from it."""
    found = tracebacks.last_traceback(trace)
    if found is None or trace.exit is None:
        return None
    if found.type != "ZeroDivisionError" and "timer period must be non-negative" not in found.message:
        return None
    observed = f"{parameter.name} set to {answer.values[parameter.name]} ends the node: {found.plain}"
    return failed(expected, observed, _accepted(parameter, trace, answer), output_tail(trace))


def _accepted(parameter: Parameter, trace: Trace, answer: SetAnswer) -> Observation:
    value = answer.values[parameter.name]
    return Symptom.BAD_VALUE_ACCEPTED.seen(trace, parameter=parameter.name, value=value, answer=answer)


def _taken_over(parameter: Parameter, trace: Trace, what: str) -> Observation:
    """A value was rejected, and something has changed all the same."""
    return Symptom.BAD_VALUE_ACCEPTED.seen(trace, parameter=parameter.name, taken_over=what)


def _rate_changed(parameter: Parameter, trace: Trace, rate: Rate | None) -> Observation:
    """A value was rejected, and messages come at another rate, or no more."""
    if trace.exit is not None:
        return Symptom.ENDED.seen(trace)
    return _taken_over(parameter, trace, "the rate changes" if rate is not None else "the messages stop")
