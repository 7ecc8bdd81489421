"""I1.3: where a server that answers a division by zero silently should log the error."""

from __future__ import annotations

import ast

import pytest

from checks.i1_3.division_by_zero import log_division_by_zero, return_zero
from checks.i1_3.services import guard_division
from tests.checks.builders import trace
from tutor.judge.step_parsing import apply_step

HEAD = """
class Calculator(Node):
    def __init__(self):
        super().__init__('calculator')
"""
MAIN = """
def main():
    node = Calculator()
    try: rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException): pass
"""
LAMBDA = "        self.create_service(AddTwoInts, 'divide', lambda q, p: self.ans(q, p, q.a // q.b if q.b else 0))\n"
LOG = "self.get_logger().error('division by zero')"


def method(*body: str) -> str:
    return HEAD + "    def divide(self, req, resp):\n" + "".join(f"        {line}\n" for line in body)


@pytest.mark.parametrize(
    ("text", "step"),
    [
        (
            method("try:", "    resp.sum = req.a // req.b", "except ZeroDivisionError:", "    pass", "return resp"),
            f"in node.py, line 9 becomes: {LOG}",
        ),
        (
            method("try: resp.sum = int(req.a / req.b)", "except: pass", "return resp"),
            f"in node.py, line 7 becomes:\n    except:\n        {LOG}",
        ),
        (
            method("try:", "    resp.sum = req.a // req.b", "except ZeroDivisionError:", "    return resp"),
            f"in node.py, write above line 9, with the same indentation: {LOG}",
        ),
        (
            method("if req.b == 0: resp.sum = 0; return resp", "resp.sum = req.a // req.b", "return resp"),
            f"in node.py, write above line 7, with the same indentation:\n    if req.b == 0:\n        {LOG}",
        ),
        (
            method("if req.b == 0:", "    resp.sum = 0", "else:", "    resp.sum = req.a // req.b", "return resp"),
            f"in node.py, write above line 7, with the same indentation: {LOG}",
        ),
        (
            method("if req.b != 0:", "    resp.sum = req.a // req.b", "else:", "    resp.sum = 0", "return resp"),
            f"in node.py, write above line 9, with the same indentation: {LOG}",
        ),
        (
            method("if req.b:", "    resp.sum = req.a // req.b", "return resp"),
            f"in node.py, write below line 7, with the indentation of line 6:\n    else:\n        {LOG}",
        ),
        (
            method("resp.sum = req.a // req.b if req.b else 0", "return resp"),
            f"in node.py, write above line 6, with the same indentation:\n    if req.b == 0:\n        {LOG}",
        ),
        (
            method("resp.sum = req.a // max(1, req.b)", "return resp"),
            f"in node.py, write above line 6, with the same indentation:\n    if req.b == 0:\n        {LOG}",
        ),
        (
            "node = rclpy.create_node('c')\ndef divide(req, resp):\n    resp.sum = req.b and req.a // req.b\n",
            "in node.py, write above line 3, with the same indentation:\n    if req.b == 0:\n        "
            "node.get_logger().error('division by zero')",
        ),
        ("x = 1", None),
    ],
)
def test_where_the_error_is_logged(text: str, step: str | None) -> None:
    assert log_division_by_zero(trace(sources={"node.py": text + MAIN})) == step


def test_a_class_that_is_no_node_does_not_log() -> None:
    """The callback's broad handler does: it has the node."""
    divider = "class Divider:\n    def divide(self, a, b):\n        return a // b\n"
    body = (
        "try:",
        "    resp.sum = Divider().divide(req.a, req.b)",
        "except Exception:",
        "    resp.sum = 0",
        "return resp",
    )
    text = divider + method(*body)
    line = text[: text.index("    resp.sum = 0")].count("\n") + 1
    step = log_division_by_zero(trace(sources={"node.py": text + MAIN}))
    assert step == f"in node.py, write above line {line}, with the same indentation: {LOG}"


def test_a_lambda_becomes_a_method() -> None:
    text = HEAD + LAMBDA + MAIN
    step = guard_division(trace(sources={"node.py": text}))
    assert step is not None
    becomes = "line 5 becomes: self.create_service(AddTwoInts, 'divide', self.divide_callback)"
    assert step.endswith(becomes)
    after = ast.unparse(ast.parse(apply_step(step, {"node.py": text})["node.py"]))
    assert "def divide_callback(self, request, response):" in after
    assert LOG in after


GUARD = f"if req.b == 0:\n            {LOG}\n            resp.sum = 0\n            return resp"


def test_a_division_is_guarded_first_and_its_callback_rewritten_next() -> None:
    text = (
        HEAD
        + "        self.create_service(AddTwoInts, 'divide', self.divide)\n\n"
        + method("self.lock.acquire()", "resp.sum = req.a // req.b", "return resp").removeprefix(HEAD)
    )
    step = guard_division(trace(sources={"node.py": text}))
    assert step is not None
    once = apply_step(step, {"node.py": text})["node.py"]
    assert f"def divide(self, req, resp):\n        {GUARD}\n        self.lock.acquire()" in once
    again = guard_division(trace(sources={"node.py": once}))
    assert again is not None
    assert (
        f"{GUARD}\n        resp.sum = req.a // req.b\n        return resp"
        in apply_step(again, {"node.py": once})["node.py"]
    )


def test_a_method_that_returns_the_quotient_returns_zero() -> None:
    text = (
        "class Divide(Operation):\n    def ready(self):\n        self.get_logger().info('ready')\n"
        "    def operate(self, a, b):\n        return a // b\n"
    )
    step = return_zero(trace(sources={"node.py": text + MAIN}))
    assert step is not None
    assert "write above line 5" in step
    assert [line.strip() for line in step.splitlines()[1:]] == [
        "if b == 0:",
        "self.get_logger().error('division by zero')",
        "return 0",
    ]


def test_a_function_without_a_logger_is_left_alone() -> None:
    assert (
        return_zero(trace(sources={"node.py": "class Divide:\n    def operate(self, a, b):\n        return a // b\n"}))
        is None
    )
