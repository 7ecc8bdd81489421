"""Service callbacks that return no response."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import replace

from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.exceptions import EXPLAINED, found_in, from_example, raised_in
from tutor.mistakes.exceptions.known import Example
from tutor.source import Function, NodeFile, argument, called_name, values_of


@mistake(
    "response-not-returned",
    explains=EXPLAINED,
    evidence=Evidence.PROCESS,
    slip=True,
    says="{raised}: {what}, and rclpy has no response to send",
    do="{step}",
    example=from_example(
        Example(
            "TypeError: ",
            "rclpy.spin(node)",
            "class Bell(Node):\n    def __init__(self):\n        self.create_service(Trigger, 'ring', self.ring)\n\n"
            "    def ring(self, request, response):\n        response.success = True\n\nrclpy.spin(node)\n",
            at="/lib/rclpy/service.py, send_response",
        )
    ),
)
def response_not_returned(case: Case) -> Iterator[Found]:
    """A service callback returns no response.

    rclpy makes a response, passes it to the callback, and sends what the callback returns. Filling the fields is not
    enough: without a return the callback returns None, which ends the node with a TypeError.

    Bad:

        def ring(self, request, response):
            response.success = True

    Good:

        def ring(self, request, response):
            response.success = True
            return response

    See it: the caller waits forever, and the node is gone.

    Lesson: i1.3, answering a call.
    """
    for seen in raised_in(case):
        if seen.name != "TypeError" or not seen.is_raised_in("rclpy/service.py"):
            continue
        for file in case.files:
            for function in _candidates(file):
                for told in _without_response(file, function):
                    yield replace(told, words={**told.words, "raised": "the node ends with a TypeError"})
        yield found_in(
            seen,
            what="a service callback returned something other than its response",
            step="Return the response on every path through the callback.",
        )


def _candidates(file: NodeFile) -> list[Function]:
    """The callbacks of services, then what looks like one, then the functions inside decorators."""
    given = [file.function(argument(call, "callback")) for call in file.calls("create_service")]
    alike = [
        function
        for function in file.functions
        if re.match(r"re?s", _response(function)) or ".Response" in ast.unparse(function)
    ]
    inner = [function for function in file.functions if file.function_around(function) is not None]
    wrappers = [function for function in inner if function.args.vararg is not None]
    return [candidate for candidate in dict.fromkeys([*given, *alike, *wrappers]) if candidate is not None]


def _response(function: Function) -> str:
    """The name of the response: the second parameter after self; empty if there is none."""
    names = [parameter.arg for parameter in function.args.args if parameter.arg not in ("self", "cls")]
    return names[1] if len(names) > 1 else ""


def _without_response(file: NodeFile, function: Function) -> Iterator[Found]:
    """Where a callback returns something else than a response."""
    response = _response(function)
    name = response or "what the function that it wraps returned"
    end = f"End {function.name} with a return of {name}."
    returns = [node for node in ast.walk(function) if isinstance(node, ast.Return)]
    for node in sorted(returns, key=lambda statement: statement.lineno):
        if file.function_around(node) is not function:
            continue
        step = f"Return {name} in line {node.lineno}."
        if node.value is None or (isinstance(node.value, ast.Constant) and node.value.value is None):
            yield found(file, node, what=f"line {node.lineno} of {function.name} returns nothing", step=step)
            continue
        kept = values_of(node.value.id, function) if isinstance(node.value, ast.Name) else []
        classes = [value for value in kept if ast.unparse(value).endswith(".Response")]
        if classes:
            what = f"line {classes[0].lineno} keeps the class of the response, not an object"
            yield found(file, classes[0], what=what, step="Add the parentheses after Response.")
        elif not all(_may_be_response(value, response) for value in kept or [node.value]):
            what = f"line {node.lineno} of {function.name} returns {ast.unparse(node.value)}"
            yield found(file, node, what=what, step=f"Put that into a field of {name}, and return {name}.")
    if not _always_ends(function.body):
        yield found(file, function, what=f"{function.name} (line {function.lineno}) ends without a return", step=end)


def _may_be_response(value: ast.expr, response: str) -> bool:
    match value:
        case ast.Name(id=name):
            return name == response or not response
        case ast.Await():
            return True
        case ast.Call():
            return called_name(value) not in ("int", "float", "str", "bool", "round")
        case ast.IfExp(body=body, orelse=other):
            return _may_be_response(body, response) and _may_be_response(other, response)
    return not isinstance(value, ast.BinOp | ast.Constant | ast.Attribute | ast.Tuple | ast.Dict)


def _always_ends(block: list[ast.stmt]) -> bool:
    """Whether every path through a block ends with a return or a raise."""
    match block[-1]:
        case ast.Return() | ast.Raise():
            return True
        case ast.If(body=body, orelse=other) if other:
            return _always_ends(body) and _always_ends(other)
        case ast.With(body=body) | ast.AsyncWith(body=body):
            return _always_ends(body)
        case ast.Try(body=body, handlers=handlers, orelse=other, finalbody=final):
            paths = [other or body, *(handler.body for handler in handlers)]
            return (bool(final) and _always_ends(final)) or all(_always_ends(path) for path in paths)
        case ast.Match(cases=cases):
            last = cases[-1].pattern
            return (
                isinstance(last, ast.MatchAs)
                and last.pattern is None
                and all(_always_ends(branch.body) for branch in cases)
            )
        case ast.While(test=ast.Constant(value=True)):
            return True
    return False
