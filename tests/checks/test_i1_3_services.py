"""I1.3: verdicts on fabricated answers of a calculator."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i1_3_calculator_service import CHECK, SERVICES, TYPE, random_operands
from tests.checks.builders import (
    CRASH,
    CRASHED,
    EXECUTING,
    NO_NODE,
    NODE_UP,
    assert_passed,
    assert_skipped,
    called,
    ending,
    exited,
    explained,
    frame,
    graph,
    judge_of,
    trace,
)
from tests.checks.calculator import (
    ALL,
    ANSWERS,
    COMPUTES,
    IN_CALL,
    SERVING,
    assert_failed,
    correct_result,
    right_answer,
)
from tutor.exercise import Program
from tutor.exercise.service_calls import Server, ServiceCalls
from tutor.exercise.survives_bad_call import CallsAroundBad
from tutor.judge.trace import CallAnswer
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Status, Verdict
from tutor.ros_model import Graph

judge_services = judge_of(CHECK, "services")
judge_operations_after = judge_of(CHECK, "operations")
judge_division = judge_of(CHECK, "divide-by-zero")
judge_shutdown = judge_of(CHECK, "shutdown")

SILENT = called("/add", 6, 3, None)
DEAD = trace(graph=ALL, err=CRASH, exit=exited(1))
PARAMETERS, TRIGGER = "rcl_interfaces/srv/SetParameters", "std_srvs/srv/Trigger"


def judge_operations(seen: ServiceCalls) -> Verdict:
    return judge_operations_after(seen, serving(*ANSWERS))


def serving(*answers: CallAnswer, **more: Any) -> ServiceCalls:
    return ServiceCalls(SERVING, answers, **more)


def without(service: str, **others: str) -> ServiceCalls:
    """What is observed of a node with the other services, and those of these names and types instead."""
    kept = tuple(server for server in ALL.servers if server.name != service)
    more = graph(services={f"/{name}".replace("__", "/"): kind for name, kind in others.items()})
    return ServiceCalls(trace(graph=Graph(ALL.nodes, servers=(*kept, *more.servers))), ())


@pytest.mark.parametrize(
    "seen",
    [serving(*ANSWERS), ServiceCalls(trace(graph=ALL, err="[INFO] ready"), ANSWERS, spins=False)],
    ids=["in time", "does not spin, but answered"],
)
def test_services_pass(seen: ServiceCalls) -> None:
    assert_passed(judge_services(seen))


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (ServiceCalls(CRASHED, ()), "unhandled exception", "line 12"),
        (ServiceCalls(DEAD, (SILENT,), ready=False), "unhandled exception", ""),
        (ServiceCalls(NO_NODE, ()), "no node", ""),
        (ServiceCalls(trace(graph=NODE_UP), ()), "service missing", "are not there"),
        (replace(without("/divide"), answers=ANSWERS[:3]), "service missing", "/divide is not there"),
        (without("/add", node__set_parameters=PARAMETERS), "service missing", "/add"),
        (serving(), "service missing", "/add"),
        (serving(*ANSWERS[:3]), "service missing", "/divide"),
        (replace(without("/add", add=TRIGGER), answers=ANSWERS[1:]), "wrong type", TRIGGER),
        (without("/add", calc__add=TYPE), "wrong service name", "/calc/add"),
        (without("/subtract", sub=TYPE), "wrong service name", "/sub"),
        (without("/add", Add=TYPE), "wrong service name", "/Add"),
        (serving(SILENT, spins=False), "no spin", "/node"),
        (serving(SILENT, stuck=IN_CALL), "deadlock by call()", "line 12"),
        (serving(SILENT, stuck=(frame("add"), EXECUTING)), "blocked executor", "line 12"),
        (serving(*ANSWERS[:3], called("/divide", 6, 3, None)), "no answer", "/divide"),
    ],
)  # fmt: skip
def test_services_fail(seen: ServiceCalls, cause: str, word: str) -> None:
    assert_failed(judge_services(seen), cause, word)


@pytest.mark.parametrize("last", [2, None, -1])
def test_a_server_that_a_call_ends_is_told_by_operations_whether_the_answer_got_out_or_not(last: int | None) -> None:
    seen = ServiceCalls(DEAD, (*ANSWERS[:3], called("/divide", 6, 3, last)))
    assert_skipped(judge_services(seen), "`operations` shows why")
    assert_failed(
        judge_operations_after(ServiceCalls(DEAD, (called("/divide", 60, 3, None),)), seen), "unhandled exception"
    )
    good = called("/divide", 84, 7, last)
    assert_skipped(judge_division(CallsAroundBad(DEAD, good)), "`operations` shows why")
    assert_skipped(judge_division(CallsAroundBad(DEAD, good, (good, called("/divide", 84, 7, None)))), "`operations`")


def test_a_service_of_the_wrong_type_is_missing() -> None:
    server = Server(Program("server.py"), SERVICES)
    others = graph(services={"/add": TYPE, "/subtract": "a/srv/B"}).servers
    assert server.missing(ALL.servers) == []
    assert [service.name for service in server.missing(others)] == ["/subtract", "/multiply", "/divide"]


def _divisible(asked: tuple[str, int, int]) -> tuple[str, int, int]:
    service, a, b = asked
    return (service, a * b, b) if service == "/divide" else asked


operands = st.tuples(st.sampled_from(list(COMPUTES)), st.integers(-1000, 1000), st.integers(-20, 20).filter(bool)).map(
    _divisible
)
right_answers = operands.map(lambda asked: right_answer(*asked))
one_of_each = st.tuples(
    *(operands.map(lambda asked, s=service: right_answer(s, asked[2] * 7, asked[2])) for service in COMPUTES)  # type: ignore[misc]
)


@given(one_of_each, st.lists(right_answers))
def test_right_results_pass(first: tuple[CallAnswer, ...], more: list[CallAnswer]) -> None:
    assert_passed(judge_operations(serving(*first, *more)))


@given(operands, st.integers(), st.lists(right_answers, max_size=5))
def test_any_wrong_result_fails(asked: tuple[str, int, int], result: int, before: list[CallAnswer]) -> None:
    if result != correct_result(*asked):
        verdict = judge_operations(serving(*ANSWERS, *before, called(*asked, result)))
        assert verdict.status is Status.FAILED
        assert verdict.observed == str(result)
        told = explained(verdict, CHECK)
        assert told.cause
        assert told.step


@pytest.mark.parametrize(
    ("service", "results", "cause", "word"),
    [
        ("/add", [(20, 3, 17), (9, 4, 5)], "another operation", "/add answers what /subtract should"),
        ("/multiply", [(20, 3, 23), (-4, 2, -2)], "another operation", "/add should"),
        ("/add", [(20, 3, 17), (9, 4, 6)], "wrong answer", "17 instead of 23"),
        ("/subtract", [(20, 3, -17), (3, 10, 7)], "operands the wrong way round", "order of a and b"),
        ("/divide", [(60, 3, 0), (-60, 3, -1)], "operands the wrong way round", "/divide"),
        ("/divide", [(-60, 3, 20), (60, 3, 20)], "sign lost", "abs()"),
        ("/add", [(-40, 4, 44), (-8, -9, 17)], "sign lost", "abs()"),
        ("/add", [(5 * 10**9, 3, 705032707), (6, 3, 9)], "cut to 32 bits", "64 bits"),
        ("/add", [(-5 * 10**9, 3, -705032701), (6, 3, 9)], "cut to 32 bits", "64 bits"),
        ("/multiply", [(20, 3, 0), (6, 4, 0)], "response field not set", "response's field"),
        ("/multiply", [(20, 3, 0), (6, 4, 24)], "wrong answer", "0 instead of 60"),
        ("/add", [(20, 3, 99)], "wrong answer", "99 instead of 23"),
        ("/add", [(20, 3, None)], "no answer", "no answer in 5 s"),
        ("/add", [(6, 3, 9), (-40, 4, 0), (50, -5, 0), (7, 7, 14)], "negative operands refused", "/add answers 0"),
        ("/divide", [(6, 3, 2), (-1, -1, 1), (0, -1, 1)], "wrong answer", "1 instead of 0"),
        ("/add", [(-40, 4, -36), (7, 0, 0)], "zero refused", "/add computes with every other number"),
        ("/add", [(-40, 4, 0), (7, 0, 0)], "response field not set", "/add answers 0"),
    ],
)
def test_causes_of_a_wrong_result(
    service: str, results: list[tuple[int, int, int | None]], cause: str, word: str
) -> None:
    others = [answer for answer in ANSWERS if answer.service != service]
    seen = serving(*others, *(called(service, a, b, result) for a, b, result in results))
    assert_failed(judge_operations(seen), cause, word)


def test_an_unknown_field_of_the_response_is_named_with_the_fields_that_there_are() -> None:
    text = """
from example_interfaces.srv import AddTwoInts
def add(self, request, response):
    return AddTwoInts.Response(result=request.a + request.b)
"""
    run = trace(graph=ALL, sources={"node.py": text})
    seen = ServiceCalls(run, (called("/add", 20, 3, 0), called("/add", -4, 9, 0)))
    assert_failed(
        judge_operations(seen), "unknown field in a constructor", "line 4", "no field result", "Use the field sum"
    )


LAMBDA = """
for name, function in OPERATIONS.items():
    self.create_service(AddTwoInts, name, lambda request, response: self.compute(name, function, request, response))
"""
BOUND = LAMBDA.replace("response: self", "response, name=name, function=function: self")


@pytest.mark.parametrize(
    ("text", "computes", "cause"),
    [
        (LAMBDA, ("/multiply",) * 4, "late binding"),
        (BOUND, ("/multiply",) * 4, "another operation"),
        (LAMBDA, ("/multiply", "/subtract", "/multiply", "/divide"), "another operation"),
    ],
)
def test_services_that_all_compute_the_same(text: str, computes: tuple[str, ...], cause: str) -> None:
    answers = [
        called(name, a, b, correct_result(other, a, b))
        for name, other in zip(COMPUTES, computes, strict=True)
        for a, b in ((20, 4), (-21, 7))
    ]
    run = trace(graph=ALL, sources={"node.py": text})
    assert_failed(judge_operations(ServiceCalls(run, tuple(answers))), cause)


def test_an_exception_in_a_callback_is_named() -> None:
    assert_failed(judge_operations(ServiceCalls(DEAD, (SILENT,))), "unhandled exception", "self.nothing()")


@pytest.mark.parametrize(
    "seen",
    [
        ServiceCalls(trace(graph=NODE_UP), ()),
        replace(without("/add"), answers=ANSWERS[1:]),
        serving(SILENT),
        ServiceCalls(CRASHED, ()),
    ],
    ids=["no service", "one is missing", "one does not answer", "crashed"],
)
def test_operations_are_skipped_if_services_failed(seen: ServiceCalls) -> None:
    assert_skipped(judge_operations_after(serving(*ANSWERS), seen), "`services` did not pass")


@pytest.mark.parametrize("answers", [(), ANSWERS[:3]])
def test_operations_fail_if_a_service_was_not_called(answers: tuple[CallAnswer, ...]) -> None:
    assert_failed(judge_operations(serving(*answers)), "service missing", "/divide")


def test_operands() -> None:
    chosen = random_operands()
    assert {(a > 0, b > 0) for a, b in chosen if a} == {(True, True), (True, False), (False, True), (False, False)}
    assert [a for a, _ in chosen].count(0) == 1
    assert any(abs(a) > 2**32 for a, _ in chosen)
    for a, b in chosen:
        assert b != 0 == a % b
        assert max(abs(correct_result(service, a, b)) for service in COMPUTES) < 2**53


POLLING = """
class Calculator(Node):
    def __init__(self):
        self.client = self.create_client(AddTwoInts, 'add')
        self.create_service(AddTwoInts, 'subtract', self.subtract)

    def subtract(self, request, response):
        future = self.client.call_async(request)
        while rclpy.ok():
            if future.done():
                break
            time.sleep(0.1)
        return response
"""


POLLS = (frame("subtract", line=12, code="time.sleep(0.1)"), EXECUTING)
POOL = frame("run", "/usr/lib/python3.12/concurrent/futures/thread.py")


@pytest.mark.parametrize(
    ("stuck", "busy"), [(POLLS, "the executor"), ((*POLLS, POOL), "its callback group"), ((), "the executor")]
)
def test_a_future_polled_in_a_callback_of_the_clients_own_group(stuck: tuple[Frame, ...], busy: str) -> None:
    run = trace(graph=ALL, sources={"node.py": POLLING})
    verdict = judge_services(ServiceCalls(run, (called("/subtract", 6, 3, None),), stuck=stuck))
    assert_failed(verdict, "polls a future", "waits for future", f"keeps {busy} busy")


def test_a_server_that_sleeps_instead_of_spinning_is_told_to_spin() -> None:
    text = "import time\nimport rclpy\nrclpy.init()\nnode = rclpy.create_node('c')\nwhile True:\n    time.sleep(0.2)\n"
    run = trace(graph=ALL, sources={"node.py": text})
    sleeping = (frame("<module>", line=6, code="time.sleep(0.2)"),)
    verdict = judge_services(ServiceCalls(run, (SILENT,), spins=False, stuck=sleeping))
    assert_failed(verdict, "no spin", "line 6")


def test_shutdown() -> None:
    assert_passed(judge_shutdown(serving(*ANSWERS, ending=ending(0))))
    assert_passed(judge_shutdown(serving(*ANSWERS, ending=ending(130))))
    assert_failed(judge_shutdown(serving(*ANSWERS, ending=ending(still_running=True))), "does not end")
    assert_skipped(judge_shutdown(ServiceCalls(CRASHED, ())), "`services` shows why")
    assert_skipped(judge_shutdown(ServiceCalls(trace(graph=ALL, exit=exited(1)), ANSWERS)), "`operations` shows why")
