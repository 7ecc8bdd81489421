"""I1.3: where a server that answers a division by zero without a word is told to log it."""

from __future__ import annotations

import ast

import pytest

from checks.i1_3.zero import where_to_log
from tests.checks.made import trace

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
            f"in node.py, write in place of pass, line 9: {LOG}",
        ),
        (
            method("try: resp.sum = int(req.a / req.b)", "except: pass", "return resp"),
            f"in node.py, line 7 becomes: except: {LOG}",
        ),
        (
            method("try:", "    resp.sum = req.a // req.b", "except ZeroDivisionError:", "    return resp"),
            f"in node.py, write above line 9, with the same indentation: {LOG}",
        ),
        (
            method("if req.b == 0: resp.sum = 0; return resp", "resp.sum = req.a // req.b", "return resp"),
            f"in node.py, line 6 becomes: if req.b == 0: {LOG}; resp.sum = 0; return resp",
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
            f"in node.py, write below line 7, indented as the if in line 6: else: {LOG}",
        ),
        (
            method("resp.sum = req.a // req.b if req.b else 0", "return resp"),
            f"in node.py, write above line 6, with the same indentation: if req.b == 0: {LOG}",
        ),
        (
            method("resp.sum = req.a // max(1, req.b)", "return resp"),
            f"in node.py, write above line 6, with the same indentation: if req.b == 0: {LOG}",
        ),
        (
            "node = rclpy.create_node('c')\ndef divide(req, resp):\n    resp.sum = req.b and req.a // req.b\n",
            "in node.py, write above line 3, with the same indentation: if req.b == 0: "
            "node.get_logger().error('division by zero')",
        ),
        ("x = 1", f"in the callback of /divide, where b is 0, before you return the response: {LOG}"),
    ],
)
def test_the_line_to_write(text: str, step: str) -> None:
    assert where_to_log(trace(sources={"node.py": text + MAIN})) == step


def test_a_lambda_gets_a_function_of_its_own() -> None:
    text = HEAD + LAMBDA + MAIN
    becomes, where, *body = where_to_log(trace(sources={"node.py": text})).splitlines()
    assert becomes == ("in node.py, line 5 becomes: self.create_service(AddTwoInts, 'divide', self.divide_callback)")
    assert where == "and above line 3, indented as it is:"
    lines = text.splitlines()
    lines[4] = "        " + becomes.partition("becomes: ")[2]
    lines[2:2] = [f"    {each}" for each in body]
    followed = ast.unparse(ast.parse("\n".join(lines)))
    assert "def divide_callback(self, request, response):" in followed
    assert LOG in followed
