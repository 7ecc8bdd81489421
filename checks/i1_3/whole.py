"""I1.3: the last resort, where no smaller step is left: the file as a whole, in the learner's own names."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import wraps

from checks.i1_3.code import Code, stepped
from checks.i1_3.facts import SIGNS, Calls, Division
from checks.i1_3.requests import LONG
from checks.i1_3.services import arguments, callback, lines_for, means
from tutor.judge import edits
from tutor.judge.rewriting.node import argument
from tutor.judge.rewriting.whole import rewritten
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause, Status, Verdict


def followable[Seen: Calls | Division](judge: Callable[[Seen], Verdict]) -> Callable[[Seen], Verdict]:
    """The judge of a server, whose steps can be followed word for word wherever there is a file to edit."""

    @wraps(judge)
    def judged(seen: Seen) -> Verdict:
        verdict = judge(seen)
        if verdict.status is not Status.FAILED or verdict.hint.startswith("rename"):
            return verdict
        told = stepped(Cause("", verdict.cause, verdict.hint), seen.trace, lambda: server(seen.trace))
        return replace(verdict, hint=told.hint)

    return judged


def server(trace: Trace) -> str | None:
    """The step that writes a server which offers all four services, and ends with Ctrl+C."""
    if trace.file not in trace.sources:
        return None
    code = Code(trace.sources[trace.file], trace.file)
    named = {service: _callback(trace, service) for service in SIGNS}
    own = next(iter(code.node_classes), "CalculatorServer")
    lines = [
        "import rclpy",
        "from example_interfaces.srv import AddTwoInts",
        "from rclpy.executors import ExternalShutdownException",
        "from rclpy.node import Node",
        *("", ""),
        f"class {own}(Node):",
        "    def __init__(self):",
        f"        super().__init__({_node_name(code, 'calculator_server')!r})",
        *(f"        self.create_service(AddTwoInts, {name[1:]!r}, self.{named[name][0]})" for name in SIGNS),
    ]
    for service, (name, request, response) in named.items():
        body = lines_for(request, response, service, "self.get_logger()")
        lines += ["", f"    def {name}(self, {request}, {response}):", *(f"        {line}" for line in body)]
    lines += [
        *("", ""),
        "def main():",
        "    rclpy.init()",
        f"    node = {own}()",
        "    try:",
        "        rclpy.spin(node)",
        "    except (KeyboardInterrupt, ExternalShutdownException):",
        "        pass",
        "    finally:",
        "        node.destroy_node()",
        "        rclpy.try_shutdown()",
    ]
    return _written(code, lines)


def client(code: Code) -> str | None:
    """The step that writes a client which waits for each service, calls it, and ends."""
    lines = [
        "import rclpy",
        "from example_interfaces.srv import AddTwoInts",
        *("", ""),
        "def main():",
        "    rclpy.init()",
        f"    node = rclpy.create_node({_node_name(code, 'calculator_client')!r})",
        "    for name in ('add', 'subtract', 'multiply', 'divide'):",
        "        client = node.create_client(AddTwoInts, name)",
        f"        client.{LONG}",
        "        future = client.call_async(AddTwoInts.Request(a=8, b=2))",
        "        rclpy.spin_until_future_complete(node, future)",
        "        node.get_logger().info(f'{name}: {future.result().sum}')",
        "    node.destroy_node()",
        "    rclpy.try_shutdown()",
    ]
    return _written(code, lines)


def _written(code: Code, lines: Sequence[str]) -> str | None:
    """The lines in place of the file's code; what is said above it stays."""
    whole = "\n".join([*lines, "", "", 'if __name__ == "__main__":', "    main()"])
    return code.told(rewritten(code, whole) or edits.Edit(1, len(code.text.splitlines()), whole))


def _callback(trace: Trace, service: str) -> tuple[str, str, str]:
    """What the callback of a service, its request and its response are called."""
    found = callback(trace, service)
    if found is None:
        return f"{service[1:]}_callback", "request", "response"
    code, function = found
    request, response = arguments(code, function)[:2]
    return function.name if means(function.name, service) else f"{service[1:]}_callback", request, response


def _node_name(code: Code, usual: str) -> str:
    return next(_names(code), usual)


def _names(code: Code) -> Iterator[str]:
    for call in code.calls("__init__", "create_node", "Node"):
        name = argument(call, 0, "node_name")
        if isinstance(name, ast.Constant) and isinstance(name.value, str) and name.value.isidentifier():
            yield name.value
