"""I1.3: services that compute the result of another one, and the line that is to blame."""

from __future__ import annotations

import pytest

from checks.i1_3.facts import OPERATOR_SIGNS, TYPE, ServiceCalls, correct_result
from checks.i1_3.judges import judge_operations
from checks.i1_3.services import compute_results
from tests.checks.builders import assert_failed, called, graph, trace
from tutor.judge.verdict import Status, Verdict

LAMBDA = """
for name, function in OPERATIONS.items():
    self.create_service(AddTwoInts, name, lambda request, response: self.compute(name, function, request, response))
"""
BOUND = "lambda request, response, name=name, function=function: self.compute("
NESTED = """
for name in OPERATIONS:
    function = OPERATIONS[name]
    def callback(req: Request, res: Response) -> Response:
        res.sum = function(req.a, req.b)
        return res
    node.create_service(AddTwoInts, name, callback)
"""
LISTED = "[self.create_service(AddTwoInts, n, lambda q, p: self.do(OPS[n], q, p)) for n in OPS]"


def calls_of(text: str, computes: str = "/multiply") -> ServiceCalls:
    """The calls of a server with this source, whose four services all compute the same."""
    answers = [
        called(name, a, b, correct_result(computes, a, b)) for name in OPERATOR_SIGNS for a, b in ((20, 4), (-21, 7))
    ]
    return ServiceCalls(
        trace(graph=graph(services=dict.fromkeys(OPERATOR_SIGNS, TYPE)), sources={"node.py": text}), tuple(answers)
    )


def judge(seen: ServiceCalls) -> Verdict:
    return judge_operations(seen, seen)


@pytest.mark.parametrize(
    ("text", "line", "step"),
    [
        (LAMBDA, "the lambda in line 3", f"line 3 becomes: self.create_service(AddTwoInts, name, {BOUND}"),
        (
            NESTED,
            "the function callback in line 4",
            "line 4 becomes: def callback(req: Request, res: Response, function=function) -> Response:",
        ),
        (LISTED, "looks n up", "lambda q, p, n=n: self.do(OPS[n], q, p)) for n in OPS]"),
    ],
)
def test_a_function_made_in_a_loop_must_bind_the_loop_variables(text: str, line: str, step: str) -> None:
    assert_failed(judge(calls_of(text)), "late binding", line, "in node.py, ", step, "what /multiply should")


@pytest.mark.parametrize(
    "text",
    [
        LAMBDA.replace("response: self", "response, name=name, function=function: self"),
        "for f in FUNCTIONS:\n    self.create_service(AddTwoInts, 'add', lambda q, f: f(q))",
        "for f in FUNCTIONS:\n    self.create_service(AddTwoInts, 'add', lambda q, r, f=f: f(q, r))",
        "for name in OPERATIONS:\n    self.create_service(AddTwoInts, name, self.made(name))",
        "",
    ],
)
def test_bound_loop_variables_are_not_blamed(text: str) -> None:
    verdict = judge(calls_of(text))
    assert verdict.status is Status.FAILED
    assert "late binding" not in verdict.cause


SERVER = """
class Calculator(Node):
    def __init__(self):
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.on_subtract)
        self.create_service(AddTwoInts, 'multiply', self.divide)
        self.create_service(AddTwoInts, '/divide', callback=self.divide)
    def add(self, req, resp):
        resp.sum = req.a - req.b
        return resp
    def on_subtract(self, req, resp):
        resp.sum = 0
        resp.sum = req.b - req.a
        return resp
    def multiply(self, req, resp):
        resp.sum = req.a * req.b
        return resp
    def divide(self, req, resp):
        resp.sum = int(req.a / req.b)
        return resp
"""


@pytest.mark.parametrize(
    ("service", "step"),
    [
        ("/add", "in node.py, line 9 becomes: resp.sum = req.a + req.b"),
        ("/subtract", "in node.py, line 13 becomes: resp.sum = req.a - req.b"),
        ("/multiply", "in node.py, line 6 becomes: self.create_service(AddTwoInts, 'multiply', self.multiply)"),
        ("/divide", "in node.py, line 19 becomes: resp.sum = req.a // req.b"),
    ],
)
def test_the_line_that_computes_the_wrong_result(service: str, step: str) -> None:
    assert compute_results(trace(sources={"node.py": SERVER}), [service]) == step


def test_the_next_step_corrects_that_line() -> None:
    assert_failed(
        judge(calls_of(SERVER, "/subtract")),
        "wrong result",
        "what /subtract would",
        "becomes: resp.sum = req.a +",
    )
