"""Why a good value of a parameter is refused, as the reason of the refusal shows."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import SetAnswer
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source.parameters import PRE_SET

_NUMBER = r"[-+\d.einf]+"
_OUT_OF_RANGE = re.compile(
    rf"out of range\.? Min: (?P<low>{_NUMBER}), Max: (?P<high>{_NUMBER}), value: (?P<value>{_NUMBER})"
)
_BETWEEN_STEPS = re.compile(
    rf"valid step\. Min: (?P<low>{_NUMBER}), max: {_NUMBER}, value: (?P<value>{_NUMBER}), step: (?P<step>{_NUMBER})"
)


def refused_with(reason: str) -> SetAnswer:
    """An answer for an example."""
    return SetAnswer({"volume": 7}, True, False, reason, 0.0, 0.1)


def refusal(case: Case) -> str:
    """The reason with which a value was refused; empty if none was."""
    answer = case.about("answer")
    return answer.reason if answer is not None and answer.answered and not answer.successful else ""


@mistake(
    "range-too-narrow",
    explains=(Symptom.REFUSED,),
    evidence=Evidence.RUN,
    says="the range in the parameter's descriptor{where} goes from {low} to {high}, and {value} is outside",
    do="Widen the range so that every good value is in it.",
    example=in_run(Symptom.REFUSED, answer=refused_with("Parameter volume out of range Min: 0, Max: 5, value: 7")),
)
def narrow_range(case: Case) -> Iterator[Found]:
    """A declared range refuses good values.

    A FloatingPointRange or IntegerRange in the descriptor lets rclpy refuse values outside it, before any callback is
    asked.

    Bad:

        ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=5)])

    Good:

        ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10)])

    See it: `ros2 param describe NODE NAME` shows the range.
    """
    if matched := _OUT_OF_RANGE.search(refusal(case)):
        yield _at_range(case, low=matched["low"], high=matched["high"], value=matched["value"])


@mistake(
    "value-between-the-steps-of-a-range",
    explains=(Symptom.REFUSED,),
    evidence=Evidence.RUN,
    says="the range of the parameter{where} has a step of {step}, so it takes {low}, {next} and so on, and {value} is "
    "none of these",
    do="Leave the step out of the range if any value between its ends is fine.",
    example=in_run(
        Symptom.REFUSED,
        answer=refused_with("The parameter value for volume is not a valid step. Min: 0, max: 10, value: 7, step: 2"),
    ),
)
def between_steps(case: Case) -> Iterator[Found]:
    """The step of a range refuses good values.

    With a step other than 0, a range takes its two ends and, between them, only values that are a whole number of steps
    from the lower end. It is no hint for a slider: rclpy refuses everything in between.

    Bad:

        ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=2)])

    Good:

        ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10)])

    See it: `ros2 param describe NODE NAME` shows the range and its step.
    """
    if matched := _BETWEEN_STEPS.search(refusal(case)):
        after = float(matched["low"]) + float(matched["step"])
        yield _at_range(case, low=matched["low"], next=f"{after:g}", value=matched["value"], step=matched["step"])


def _at_range(case: Case, **words: object) -> Found:
    """At the range of a descriptor, if there is only one in the program."""
    ranges = [(file, call) for file in case.files for call in file.calls("FloatingPointRange", "IntegerRange")]
    if len(ranges) != 1:
        return Found({"where": "", **words})
    return found(*ranges[0], where=f" (line {ranges[0][1].lineno})", **words)


@mistake(
    "read-only-parameter",
    name="read-only parameter",
    explains=(Symptom.REFUSED,),
    evidence=Evidence.RUN,
    says="{what} is read-only, so it keeps the value that it has at start-up",
    do="Leave out read_only if the value should change at run time.",
    example=in_run(
        Symptom.REFUSED, parameter="volume", answer=refused_with("Trying to set a read-only parameter: volume.")
    ),
)
def read_only(case: Case) -> Iterator[Found]:
    """A parameter is declared read-only.

    A descriptor with read_only=True fixes the value at start-up; every later set is refused by rclpy itself.

    Bad:

        self.declare_parameter('volume', 7, ParameterDescriptor(read_only=True))

    Good:

        self.declare_parameter('volume', 7)

    See it: `ros2 param describe NODE NAME` says "Read only: true".
    """
    if "read-only parameter" not in refusal(case):
        return
    name = case.about("parameter", "the parameter")
    for file in case.files:
        for node in file.nodes:
            match node:
                case ast.keyword(arg="read_only", value=ast.Constant(value=True) as value):
                    yield found(file, value, what=f"{name} (line {value.lineno})")
                case ast.Assign(targets=[ast.Attribute(attr="read_only")], value=ast.Constant(value=True)):
                    yield found(file, node, what=f"{name} (line {node.lineno})")
                case ast.arguments(args=given, defaults=defaults) if defaults:
                    for parameter, default in zip(given[-len(defaults) :], defaults, strict=True):
                        if parameter.arg == "read_only" and isinstance(default, ast.Constant) and default.value is True:
                            what = f"{name}, by the default of read_only in line {default.lineno},"
                            yield found(file, default, what=what)
    yield Found({"what": name})


@mistake(
    "parameter-refused-as-undeclared",
    name="parameter not declared",
    explains=(Symptom.REFUSED,),
    evidence=Evidence.RUN,
    says="{name} is set, and the node has not declared it: rclpy refuses such a parameter by itself",
    do="Declare it under exactly this name where the node is set up, with a default of the right type.",
    example=in_run(
        Symptom.REFUSED, parameter="volume", answer=refused_with("Invalid access to undeclared parameter(s): []")
    ),
)
def undeclared(case: Case) -> Iterator[Found]:
    """A parameter is set that the node has not declared.

    A node has the parameters that it declares. Others are refused, so that a misspelled name is noticed.

    Bad:

        self.volume = 7

    Good:

        self.declare_parameter('volume', 7)

    See it: `ros2 param list NODE`.
    """
    if re.search(r"undeclared parameter|has not been declared", refusal(case)):
        yield Found({"name": case.about("parameter", "the parameter")})


@mistake(
    "value-dropped-before-it-is-set",
    explains=(Symptom.REFUSED, Symptom.BAD_VALUE_ACCEPTED),
    evidence=Evidence.RUN,
    says="a pre-set callback removes the value from the list, so rclpy can only say that nothing is left",
    do="Refuse the value in an on-set callback instead, which can give a reason.",
    example=in_run(Symptom.REFUSED, answer=refused_with("parameter list cannot be empty, this might be due to ...")),
)
def value_dropped(case: Case) -> Iterator[Found]:
    """A pre-set callback drops the value.

    A callback registered with add_pre_set_parameters_callback may change the list of new values before it is checked,
    but it cannot refuse: whoever sets the value gets a message about an empty list.

    Bad:

        self.add_pre_set_parameters_callback(self.drop_bad_volumes)

    Good:

        self.add_on_set_parameters_callback(self.refuse_bad_volumes)

    See it: `ros2 param set NODE NAME VALUE` prints "parameter list cannot be empty".
    """
    if "parameter list cannot be empty" in refusal(case):
        for file in case.files:
            yield from (found(file, call) for call in file.calls(PRE_SET))
        yield Found()
