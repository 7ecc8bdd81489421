"""I1.3: a rewrite of the whole file that keeps the learner's names: the step of last resort."""

from __future__ import annotations

import ast
import textwrap
from collections.abc import Callable
from dataclasses import replace
from functools import wraps

from checks.i1_3.client_requests import WAIT_FOR_SERVICE
from checks.i1_3.code import Code, with_applicable_step
from checks.i1_3.facts import OPERATOR_SIGNS, Division, ServiceCalls
from checks.i1_3.services import argument_names, body_lines, find_callback, is_named_after
from tutor.judge import edits
from tutor.judge.rewriting.node import argument
from tutor.judge.rewriting.whole import MAIN, rewrite_file
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause, Status, Verdict

_SERVER = """\
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class {node_class}(Node):
    def __init__(self):
        super().__init__({node!r})"""

_CLIENT = """\
import rclpy
from example_interfaces.srv import AddTwoInts


def main():
    rclpy.init()
    node = rclpy.create_node({node!r})
    for name in ('add', 'subtract', 'multiply', 'divide'):
        client = node.create_client(AddTwoInts, name)
        client.{wait}
        future = client.call_async(AddTwoInts.Request(a=8, b=2))
        rclpy.spin_until_future_complete(node, future)
        node.get_logger().info(f'{{name}}: {{future.result().sum}}')
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()"""


def with_applicable_steps[Seen: ServiceCalls | Division](judge: Callable[[Seen], Verdict]) -> Callable[[Seen], Verdict]:
    """Decorate a judge of the server: its steps can be followed word for word wherever there is a file to edit."""

    @wraps(judge)
    def judged(seen: Seen) -> Verdict:
        verdict = judge(seen)
        if verdict.status is not Status.FAILED or verdict.step.startswith("rename"):
            return verdict
        cause = with_applicable_step(
            Cause("", verdict.cause, verdict.step), seen.trace, lambda: rewrite_server(seen.trace)
        )
        return replace(verdict, step=cause.hint)

    return judged


def rewrite_server(trace: Trace) -> str | None:
    """Step: rewrite the server so that it offers all four services and ends on Ctrl+C."""
    if trace.file not in trace.sources:
        return None
    file = Code(trace.sources[trace.file], trace.file)
    callbacks = {service: _callback_names(trace, service) for service in OPERATOR_SIGNS}
    node_class = next(iter(file.node_classes), "CalculatorServer")
    code = "\n".join(
        [
            _SERVER.format(node_class=node_class, node=_node_name(file, "calculator_server")),
            *(
                f"        self.create_service(AddTwoInts, {each[1:]!r}, self.{callbacks[each][0]})"
                for each in OPERATOR_SIGNS
            ),
            *(_method_code(each, *callbacks[each]) for each in OPERATOR_SIGNS),
        ]
    )
    return _replace_code(file, f"{code}\n{MAIN.format(main='main', node_class=node_class)}")


def _method_code(service: str, name: str, request: str, response: str) -> str:
    body = "\n".join(body_lines(request, response, service, "self.get_logger()"))
    return f"\n    def {name}(self, {request}, {response}):\n{textwrap.indent(body, ' ' * 8)}"


def rewrite_client(code: Code) -> str | None:
    """Step: rewrite the client so that it waits for each service, calls it, and ends."""
    return _replace_code(code, _CLIENT.format(node=_node_name(code, "calculator_client"), wait=WAIT_FOR_SERVICE))


def _replace_code(file: Code, code: str) -> str | None:
    """Step: replace the file's code, but keep the docstring and comments above it."""
    return file.as_step(rewrite_file(file, code) or edits.Edit(1, len(file.text.splitlines()), code))


def _callback_names(trace: Trace, service: str) -> tuple[str, str, str]:
    """The names of a service's callback and of its request and response arguments."""
    found = find_callback(trace, service)
    if found is None:
        return f"{service[1:]}_callback", "request", "response"
    code, function = found
    request, response = argument_names(code, function)[:2]
    return (
        function.name if is_named_after(function.name, service) else f"{service[1:]}_callback",
        request,
        response,
    )


def _node_name(code: Code, default: str) -> str:
    arguments = [argument(call, 0, "node_name") for call in code.calls("__init__", "create_node", "Node")]
    names = [each.value for each in arguments if isinstance(each, ast.Constant) and isinstance(each.value, str)]
    return next((each for each in names if each.isidentifier()), default)
