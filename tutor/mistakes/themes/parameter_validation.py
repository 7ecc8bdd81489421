"""Bad values of parameters that are accepted, or take effect in spite of a refusal."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.message_fields import unknown_field
from tutor.source import NodeFile, argument
from tutor.source.parameters import ON_SET, POST_SET, may_refuse, registered_callback


@mistake(
    "refused-without-a-reason",
    name="no reason given",
    explains=[Symptom.BAD_VALUE_ACCEPTED],
    evidence=Evidence.RUN,
    says="the refusal has an empty reason, so nobody learns what is wrong with the value",
    do="Give the SetParametersResult a reason that names the parameter and the values that it accepts.",
    example=in_run(Symptom.BAD_VALUE_ACCEPTED, parameter="volume", reason=""),
)
def no_reason(case: Case) -> Iterator[Found]:
    """A value is refused without a reason.

    The reason of a SetParametersResult is what `ros2 param set` prints. Without one, a refusal looks like a fault.

    Bad:

        return SetParametersResult(successful=False)

    Good:

        return SetParametersResult(successful=False, reason='volume must be from 0 to 10')

    See it: `ros2 param set NODE NAME BAD_VALUE`.
    """
    if case.about("reason") == "" and not any(unknown_field(case)):  # which says where the reason went
        yield Found()


@mistake(
    "message-does-not-name-the-parameter",
    name="parameter not named",
    explains=[Symptom.BAD_VALUE_ACCEPTED],
    evidence=Evidence.RUN,
    says="the message about the bad value does not name {name}, the parameter that was set",
    do="Put the parameter's name into the message.",
    example=in_run(Symptom.BAD_VALUE_ACCEPTED, parameter="volume", at_start=True, warning="too loud"),
)
def not_named(case: Case) -> Iterator[Found]:
    """A message about a bad value does not name the parameter.

    Someone who has typed several parameters on a command line cannot tell from "must be positive" which one is meant.

    Bad:

        self.get_logger().error('must be positive')

    Good:

        self.get_logger().error('volume must be positive')

    See it: start the node with a bad value.
    """
    if case.about("at_start") and case.about("warning"):
        yield Found({"name": case.about("parameter", "the parameter")})


@mistake(
    "bad-value-at-start-up",
    name="not checked at start-up",
    explains=[Symptom.BAD_VALUE_ACCEPTED],
    evidence=Evidence.RUN,
    says="a bad {name} at start-up gives {what}, so whoever typed it cannot tell which parameter is wrong",
    do="Check the value when the node is set up, and say in a message of your own which parameter is wrong.",
    example=in_run(Symptom.BAD_VALUE_ACCEPTED, parameter="volume", at_start=True),
)
def at_start(case: Case) -> Iterator[Found]:
    """A bad value at start-up is not explained.

    On-set callbacks that are registered after the declaration never see the value that was given at start-up. The node
    takes it as it is, or ends with a traceback from deep inside rclpy.

    Bad:

        self.declare_parameter('volume', 7)
        self.period = 1.0 / self.get_parameter('volume').value

    Good:

        self.declare_parameter('volume', 7)
        if self.get_parameter('volume').value <= 0:
            self.get_logger().fatal('volume must be positive')
            raise SystemExit(1)

    See it: start the node with a bad value.
    """
    if case.about("at_start") and not case.about("warning"):
        crashed = any("Traceback" in line.text for line in case.trace.output)
        what = "only a traceback" if crashed else "no message about it"
        yield Found({"name": case.about("parameter", "value"), "what": what})


@mistake(
    "value-changed-all-the-same",
    explains=[Symptom.BAD_VALUE_ACCEPTED],
    evidence=Evidence.SYMPTOM,
    says="the node refuses, but {what} all the same",
    do="Look at all values before you apply any, and apply them in a post-set callback.",
    example=in_run(Symptom.BAD_VALUE_ACCEPTED, parameter="volume", taken_over="the rate changes"),
)
def taken_over(case: Case) -> Iterator[Found]:
    """A refused value has an effect.

    An on-set callback may be asked about several parameters at once, and refuse because of the last. What it has
    already done with the first stays done. rclpy stores none of them, so the node works with values other than those it
    reports.

    Bad:

        for parameter in parameters:
            if parameter.name == 'owner':
                self.owner = parameter.value
            elif parameter.value > 10:
                return SetParametersResult(successful=False, reason='volume must be 10 at most')

    Good:

        for parameter in parameters:
            if parameter.name == 'volume' and parameter.value > 10:
                return SetParametersResult(successful=False, reason='volume must be 10 at most')

    See it: `ros2 service call NODE/set_parameters_atomically rcl_interfaces/srv/SetParametersAtomically VALUES`, with a
    good and a bad value.

    Lesson: i2.1, on checking before changing.
    """
    if case.about("taken_over"):
        yield Found({"what": case.about("taken_over")})


@mistake(
    "no-validation",
    explains=[Symptom.BAD_VALUE_ACCEPTED],
    evidence=Evidence.SYMPTOM,
    says="{why}",
    do="Look at every new value of {name} before it is stored, and refuse a bad one with a reason.",
    example=in_run(Symptom.BAD_VALUE_ACCEPTED, parameter="volume"),
)
def no_validation(case: Case) -> Iterator[Found]:
    """A bad value is accepted.

    A parameter accepts any value of its type unless a callback registered with add_on_set_parameters_callback, or a
    range in its descriptor, refuses it. Both decide before the value is stored.

    Bad:

        self.declare_parameter('volume', 7)

    Good:

        self.declare_parameter('volume', 7)
        self.add_on_set_parameters_callback(self.refuse_bad_volumes)

    See it: `ros2 param set NODE NAME BAD_VALUE` should say why the value is refused.

    Lesson: i2.1, on refusing a value.
    """
    name, value = case.about("parameter", "the parameter"), case.about("value", "a bad value")
    for file in case.files:
        for call in file.calls("FloatingPointRange", "IntegerRange"):
            low, high = (_number(argument(call, end)) for end in ("from_value", "to_value"))
            if low is not None and high is not None and isinstance(value, int | float) and low <= value <= high:
                why = f"the range in line {call.lineno} goes from {low:g} to {high:g}, and both ends are allowed"
                yield found(file, call, name=name, why=why)
        checker, later = registered_callback(file, ON_SET), registered_callback(file, POST_SET)
        if checker is not None:
            where = f"{checker.name} (line {checker.lineno})"
            refuses = may_refuse(file, checker) or _mentions_failure(file, checker.name)
            why = f"{where} can refuse a value, but does not refuse {value}" if refuses else f"{where} refuses nothing"
            yield found(file, checker, name=name, why=why)
        elif later is not None:
            why = f"{later.name} (line {later.lineno}) is called when the value is already stored, and cannot refuse it"
            yield found(file, later, name=name, why=why)
    yield Found({"name": name, "why": f"nothing checks a new value of {name} before it is stored"})


def _number(given: ast.expr | None) -> float | None:
    """The number that an argument is; None if that shows only when it runs."""
    match given:
        case ast.Constant(value=bool()):
            return None
        case ast.Constant(value=int() | float() as number):
            return float(number)
    return None


def _mentions_failure(file: NodeFile, function: str) -> bool:
    return any("successful = False" in line for line in file.text.splitlines()) and bool(function)
