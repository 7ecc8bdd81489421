"""I1.3: edits of the server's code by which a service is offered under the right name, and answers."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from checks.i1_3 import service_steps, services, steps
from checks.i1_3.code import Code
from checks.i1_3.facts import OPERATOR_SIGNS
from tests.checks.builders import trace
from tutor.judge.step_parsing import apply_step
from tutor.judge.trace import Trace

HEAD = """\
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


"""
CLASS = """\
class Calculator(Node):
    def __init__(self):
        super().__init__("calculator")
        self.create_service(AddTwoInts, "divide", self.on_divide)

    def on_divide(self, request, response):
"""


def follow_step(text: str, find_step: Callable[[Trace], str | None]) -> str | None:
    """The file after following the step, without HEAD; None if there is no step."""
    step = find_step(trace(sources={"node.py": HEAD + text}))
    return None if step is None else apply_step(step, {"node.py": HEAD + text})["node.py"].removeprefix(HEAD)


def body(*lines: str) -> str:
    return CLASS + "".join(f"        {line}\n" for line in lines)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (body("response.sum = 1"), body("response.sum = 1", "return response")),
        (
            body("try:", "    return self.do(request, response)", "except ZeroDivisionError:", "    response.sum = 0"),
            body(
                "try:",
                "    return self.do(request, response)",
                "except ZeroDivisionError:",
                "    response.sum = 0",
                "return response",
            ),
        ),
        (
            body("if request.b == 0:", "    return", "response.sum = 1", "return response"),
            body("if request.b == 0:", "    return response", "response.sum = 1", "return response"),
        ),
        (
            body("return request.a // request.b"),
            body("response.sum = request.a // request.b", "return response"),
        ),
        (
            body("return self.do(request, response)") + "\n    def do(self, q, p):\n        p.sum = 1\n",
            body("return self.do(request, response)")
            + "\n    def do(self, q, p):\n        p.sum = 1\n        return p\n",
        ),
    ],
)
def test_a_response_is_returned_on_every_path(before: str, after: str) -> None:
    assert follow_step(before, lambda run: service_steps.return_response(run, "/divide")) == after


def test_all_callbacks_that_return_nothing_return_the_response() -> None:
    names = ("add", "subtract", "multiply", "divide")
    offers = "".join(f"        self.create_service(AddTwoInts, '{name}', self.{name})\n" for name in names)
    callbacks = [f"\n    def {name}(self, q, p):\n        p.sum = 1\n" for name in names]
    before = f"class Server(Node):\n    def __init__(self):\n{offers}" + "".join(callbacks)
    after = follow_step(before, lambda run: service_steps.return_response(run, "/add"))
    assert after == before.replace("p.sum = 1\n", "p.sum = 1\n        return p\n")


WRAPPED = """\
def logged(function):
    def wrapper(self, request, response):
        function(self, request, response)

    return wrapper


""" + body("response.sum = 1", "return response").replace("    def on", "    @logged\n    def on")


def test_the_wrapper_of_a_decorated_callback_returns_the_response() -> None:
    after = follow_step(WRAPPED, lambda run: service_steps.return_response(run, "/divide"))
    assert after == WRAPPED.replace("response)\n\n    return", "response)\n        return response\n\n    return")


SAFE = """\
def safe(compute):
    def wrapper(self, request, response):
        try:
            response.sum = compute(self, request.a, request.b)
            return response
        except ZeroDivisionError:
            self.get_logger().error("division by zero")

    return wrapper


""" + body("return a // b").replace(
    "    def on_divide(self, request, response", "    @safe\n    def on_divide(self, a, b"
)


def test_a_decorator_that_answers_the_request_itself_returns_the_response_after_an_error_too() -> None:
    assert "@safe" in SAFE
    after = follow_step(SAFE, lambda run: service_steps.return_response(run, "/divide"))
    assert after == SAFE.replace('zero")\n\n    return', 'zero")\n        return response\n\n    return')


MODULE = """\
node = rclpy.create_node('calculator')
for name in NAMES:
    node.create_service(AddTwoInts, PREFIX + name, make(name))
"""


def test_missing_services_are_added_below_the_others() -> None:
    after = follow_step(body("return response"), lambda run: service_steps.add_services(run, ["/add", "/multiply"]))
    assert after is not None
    assert "self.on_divide)\n        self.create_service(AddTwoInts, 'add', self.add_callback)\n" in after
    assert (
        "    def multiply_callback(self, request, response):\n        response.sum = request.a * request.b\n" in after
    )
    after = follow_step(MODULE, lambda run: service_steps.add_services(run, ["/add"]))
    assert after is not None
    assert after.endswith("    return response\n\nnode.create_service(AddTwoInts, 'add', add_callback)\n")


def test_services_created_in_a_loop_are_renamed_and_answered_there() -> None:
    wanted = [(f"/calc{name}", name) for name in OPERATOR_SIGNS]
    after = follow_step(MODULE, lambda run: service_steps.rename_services(run, wanted))
    assert after is not None
    assert "node.create_service(AddTwoInts, '/' + (PREFIX + name).rpartition('/')[2], make(name))" in after
    after = follow_step(MODULE, lambda run: services.compute_results(run, list(OPERATOR_SIGNS)))
    assert after is not None
    assert "name=PREFIX + name: calculate(name, request, response, node.get_logger()))" in after
    assert "\ndef calculate(name, request, response, logger):\n" in f"\n{after}"


def test_a_service_of_the_wrong_type_gets_the_right_type_and_a_matching_callback() -> None:
    text = body("response.success = True", "return response").replace("AddTwoInts", "Trigger")
    after = follow_step(text, lambda run: service_steps.set_types(run, ["/divide"]))
    assert after is not None
    assert 'self.create_service(AddTwoInts, "divide", self.on_divide)' in after
    assert "self.get_logger().error('division by zero')" in after
    assert "response.success" not in after


def test_a_spinning_thread_is_no_longer_a_daemon() -> None:
    text = "t = Thread(target=executor.spin, daemon=True)\n"
    step = steps.join_thread(Code(text, "node.py"))
    assert step == "in node.py, line 1 becomes: t = Thread(target=executor.spin)"


@pytest.mark.parametrize("made", ["self.res = AddTwoInts.Response", "Response = AddTwoInts.Response"])
def test_a_response_class_that_is_returned_becomes_an_instance(made: str) -> None:
    name = made.split(" =")[0]
    text = body(made, f"{name}.sum = 1", f"return {name}")
    fixed = text.replace("AddTwoInts.Response", "AddTwoInts.Response()")
    assert follow_step(text, lambda run: service_steps.return_response(run, "/divide")) == fixed


def test_a_response_that_is_returned_in_a_tuple_is_returned_alone() -> None:
    answers = ["if request.b == 0:", "    return False, response", "response.sum = 1", "return True, response"]
    alone = [line.replace("False, ", "").replace("True, ", "") for line in answers]
    found = follow_step(body(*answers), lambda seen: service_steps.return_response(seen, "/divide"))
    assert found == body(*alone)
