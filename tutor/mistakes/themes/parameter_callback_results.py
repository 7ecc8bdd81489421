"""What a parameter callback gives rclpy for an answer, if that is no result."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.parameter_refusals import refusal, refused_with
from tutor.source import Function, NodeFile
from tutor.source.parameters import ON_SET, registered_callback

_INVALID = "Callback returned an invalid type"


@mistake(
    "callback-returns-none",
    name="callback returns None",
    explains=(Symptom.REFUSED, Symptom.BAD_VALUE_ACCEPTED),
    evidence=Evidence.RUN,
    says="rclpy takes only a SetParametersResult for an answer, and {what}",
    do="Let every way through the callback return a SetParametersResult.",
    example=in_run(Symptom.REFUSED, answer=refused_with(_INVALID)),
)
def returns_none(case: Case) -> Iterator[Found]:
    """A parameter callback returns nothing.

    rclpy asks the on-set callbacks whether a change is fine, and takes nothing but a SetParametersResult for an
    answer. A function that ends without return, or with a bare one, gives None, and the change is refused.

    Bad:

        def check(self, parameters):
            self.get_logger().info('changed')

    Good:

        def check(self, parameters):
            self.get_logger().info('changed')
            return SetParametersResult(successful=True)

    See it: `ros2 param set NODE NAME VALUE` prints "Callback returned an invalid type".
    """
    for file, callback in _invalid(case):
        if _other_result(callback) is None:
            yield found(file, callback, what=f"{callback.name} ({_nothing_returned(callback)}")
    if _invalid_type(case) and not list(_invalid(case)):
        yield Found({"what": "the parameter callback returns something else, or nothing"})


@mistake(
    "callback-returns-no-result",
    name="callback returns no SetParametersResult",
    explains=(Symptom.REFUSED, Symptom.BAD_VALUE_ACCEPTED),
    evidence=Evidence.RUN,
    says="rclpy takes only a SetParametersResult for an answer: {what}",
    do="Let {name} be a plain function that returns a SetParametersResult; its field successful says yes or no.",
    example=in_run(Symptom.REFUSED, answer=refused_with(_INVALID)),
)
def returns_no_result(case: Case) -> Iterator[Found]:
    """A parameter callback returns True or False, or is an async def.

    rclpy takes nothing but a SetParametersResult for an answer, since a refusal needs room for a reason. A coroutine
    is not awaited, so what it would return is never seen.

    Bad:

        def __init__(self):
            self.add_on_set_parameters_callback(self.check)

        def check(self, parameters):
            return parameters[0].value < 11

    Good:

        def check(self, parameters):
            return SetParametersResult(successful=parameters[0].value < 11, reason='volume must be 10 at most')

    See it: `ros2 param set NODE NAME VALUE` prints "Callback returned an invalid type".
    """
    for file, callback in _invalid(case):
        if (what := _other_result(callback)) is not None:
            yield found(file, callback, what=what, name=callback.name)


def _invalid_type(case: Case) -> bool:
    return "invalid type" in refusal(case)


def _invalid(case: Case) -> Iterator[tuple[NodeFile, Function]]:
    """The on-set callbacks, with their files, if one has returned something else than a result."""
    for file in case.files if _invalid_type(case) else ():
        callback = registered_callback(file, ON_SET)
        if callback is not None:
            yield file, callback


def _returns(callback: Function) -> list[ast.Return]:
    inner = {
        descendant
        for node in ast.walk(callback)
        if node is not callback and isinstance(node, Function | ast.Lambda)
        for descendant in ast.walk(node)
    }
    return [node for node in ast.walk(callback) if isinstance(node, ast.Return) and node not in inner]


def _other_result(callback: Function) -> str | None:
    """What a callback surely returns in place of a result, in words; None if it is nothing, or we cannot tell."""
    if isinstance(callback, ast.AsyncFunctionDef):
        return f"{callback.name} (line {callback.lineno}) is an async def, which gives a coroutine that nobody awaits"
    for statement in _returns(callback):
        match statement.value:
            case ast.Constant(value=value) if value is not None:
                return f"line {statement.lineno} returns {value!r}"
            case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not()):
                return f"line {statement.lineno} returns True or False"
            case ast.Tuple() | ast.List() | ast.Dict() | ast.JoinedStr() | ast.ListComp():
                return f"line {statement.lineno} returns {ast.unparse(statement.value)}"
    return None


def _nothing_returned(callback: Function) -> str:
    """Where a callback returns nothing, in words that begin with its line and a closing parenthesis."""
    returns = _returns(callback)
    for statement in returns:
        if statement.value is None or (isinstance(statement.value, ast.Constant) and statement.value.value is None):
            return f"line {callback.lineno}) returns None in line {statement.lineno}"
    if returns:
        return f"line {callback.lineno}) returns nothing where it ends without a return"
    return f"line {callback.lineno}) returns nothing"
