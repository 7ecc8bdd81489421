"""Why a good value of a parameter is refused, as the reason of the refusal shows."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import SetAnswer
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import Function
from tutor.source.parameters import ON_SET, PRE_SET, registered_callback

_RANGE = re.compile(r"out of range Min: (?P<low>[-\d.e+]+), Max: (?P<high>[-\d.e+]+)|not close enough to a valid step")


def _refused(reason: str) -> SetAnswer:
    return SetAnswer({"volume": 7}, True, False, reason, 0.0, 0.1)


def _reason(case: Case) -> str:
    answer = case.about("answer")
    return answer.reason if answer is not None and answer.answered and not answer.successful else ""


@mistake(
    "callback-returns-none",
    name="callback returns None",
    explains=(Symptom.REFUSED, Symptom.BAD_VALUE_ACCEPTED),
    evidence=Evidence.RUN,
    says="the parameter callback does not return a SetParametersResult{what}",
    do="Let every path through the callback return a SetParametersResult.",
    example=in_run(Symptom.REFUSED, answer=_refused("Callback returned an invalid type, it should return ...")),
)
def returns_none(case: Case) -> Iterator[Found]:
    """A parameter callback returns no SetParametersResult.

    rclpy asks the on-set callbacks whether a change is fine, and accepts nothing but a SetParametersResult as an
    answer. A function that ends without a return gives None; True is no such result either, and a coroutine is not
    awaited.

    Bad:

        def check(self, parameters):
            self.get_logger().info('changed')

    Good:

        def check(self, parameters):
            self.get_logger().info('changed')
            return SetParametersResult(successful=True)

    See it: `ros2 param set NODE NAME VALUE` prints "Callback returned an invalid type".
    """
    if "invalid type" not in _reason(case):
        return
    for file in case.files:
        callback = registered_callback(file, ON_SET)
        if callback is not None:
            yield found(file, callback, what=f": {_returned(callback)} ({callback.name}, line {callback.lineno})")
    yield Found({"what": ""})


def _returned(callback: Function) -> str:
    if isinstance(callback, ast.AsyncFunctionDef):
        return "it is an async def, which rclpy does not await"
    returns = [node.value for node in ast.walk(callback) if isinstance(node, ast.Return) and node.value is not None]
    for value in returns:
        if isinstance(value, ast.Constant):
            return f"it returns {value.value!r}"
    return "not every path through it ends with one" if returns else "it returns nothing"


@mistake(
    "range-too-narrow",
    explains=(Symptom.REFUSED,),
    evidence=Evidence.RUN,
    says="the range in the parameter's descriptor refuses {what}",
    do="Widen the range of the descriptor, or leave its step at 0.",
    example=in_run(Symptom.REFUSED, answer=_refused("Parameter volume out of range Min: 0, Max: 5, value: 7")),
)
def narrow_range(case: Case) -> Iterator[Found]:
    """A declared range refuses good values.

    A FloatingPointRange or IntegerRange in the descriptor makes rclpy refuse values outside it. With a step other than
    0, only the two ends, and values a whole number of steps above the lower end, are accepted.

    Bad:

        ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=5, step=2)])

    Good:

        ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=1)])

    See it: `ros2 param describe NODE NAME` shows the range.
    """
    if matched := _RANGE.search(_reason(case)):
        what = (
            "values between its steps" if matched["low"] is None else f"all but {matched['low']} to {matched['high']}"
        )
        yield Found({"what": what})


@mistake(
    "value-dropped-before-it-is-set",
    explains=(Symptom.REFUSED, Symptom.BAD_VALUE_ACCEPTED),
    evidence=Evidence.RUN,
    says="a pre-set callback removes the value from the list, so rclpy can only say that nothing is left",
    do="Refuse the value in an on-set callback instead, which can give a reason.",
    example=in_run(Symptom.REFUSED, answer=_refused("parameter list cannot be empty, this might be due to ...")),
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
    if "parameter list cannot be empty" in _reason(case):
        for file in case.files:
            yield from (found(file, call) for call in file.calls(PRE_SET))
        yield Found()
