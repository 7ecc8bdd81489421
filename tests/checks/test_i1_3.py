"""I1.3: verdicts on fabricated answers of a calculator and fabricated runs of its client."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.i1_3_calculator_service import CHECK, SERVICES, TYPE, random_operands
from tests.checks import builders
from tests.checks.builders import (
    CRASH,
    CRASHED,
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
    log,
    trace,
)
from tutor.exercise import Program
from tutor.exercise.client_run import ClientRun
from tutor.exercise.service_calls import Server, ServiceCalls
from tutor.exercise.survives_bad_call import CallsAroundBad, find_complaints
from tutor.judge.trace import CallAnswer, LogRecord, ServedRequest, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Status, Verdict
from tutor.ros_model import Graph, ServiceEndpoint

assert_failed = partial(builders.assert_failed, check=CHECK)

judge_services = judge_of(CHECK, "services")
judge_operations_after = judge_of(CHECK, "operations")
judge_division = judge_of(CHECK, "divide-by-zero")
judge_client = judge_of(CHECK, "client")
judge_shutdown = judge_of(CHECK, "shutdown")

COMPUTES = {service.name: service.computes for service in SERVICES}
OPERATOR_SIGNS = {service.name: service.sign for service in SERVICES}
DIVISIONS_AFTER_ZERO = ((18, 3), (-9, 0), (0, 0), (35, 5))


def correct_result(service: str, a: int, b: int) -> int:
    """The right result; 0 for a division by zero."""
    computes = COMPUTES[service]
    assert computes is not None
    return computes(a, b) or 0


def missing_services(servers: Sequence[ServiceEndpoint]) -> list[str]:
    return [service.name for service in Server(Program("server.py"), SERVICES).missing(servers)]


ALL = graph(services=dict.fromkeys(OPERATOR_SIGNS, TYPE))
SERVING = trace(graph=ALL)
EXECUTING = frame("await_or_execute", "/venv/rclpy/executors.py")
IN_CALL = (frame("wait", "/usr/lib/python3.12/threading.py"), frame("call", "/venv/rclpy/client.py"), frame("divide"))


def right_answer(service: str, a: int = 6, b: int = 3) -> CallAnswer:
    return called(service, a, b, correct_result(service, a, b))


ANSWERS = tuple(right_answer(service) for service in OPERATOR_SIGNS)


def judge_operations(seen: ServiceCalls) -> Verdict:
    return judge_operations_after(seen, ServiceCalls(SERVING, ANSWERS))


def services(**types: str) -> Graph:
    return graph(services={f"/{name}".replace("__", "/"): kind for name, kind in types.items()})


def without(service: str, more: Graph) -> Graph:
    """The services other than `service`, and those of `more`."""
    kept = tuple(each for each in ALL.servers if each.name != service)
    return Graph(ALL.nodes, servers=(*kept, *more.servers))


def test_services_pass() -> None:
    assert_passed(judge_services(ServiceCalls(SERVING, ANSWERS)))
    assert_passed(judge_services(ServiceCalls(trace(graph=ALL, err="[INFO] ready"), ANSWERS, spins=False)))


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (ServiceCalls(CRASHED, ()), "unhandled exception", "line 12"),
        (ServiceCalls(NO_NODE, ()), "no node", ""),
        (ServiceCalls(trace(graph=NODE_UP), ()), "service missing", "are not there"),
        (
            ServiceCalls(trace(graph=without("/divide", Graph())), ANSWERS[:3]),
            "service missing",
            "/divide is not there",
        ),
        (
            ServiceCalls(trace(graph=without("/add", services(add="std_srvs/srv/Trigger"))), ANSWERS[1:]),
            "wrong type",
            "std_srvs/srv/Trigger",
        ),
        (ServiceCalls(trace(graph=without("/add", services(calc__add=TYPE))), ()), "wrong service name", "/calc/add"),
        (ServiceCalls(trace(graph=without("/subtract", services(sub=TYPE))), ()), "wrong service name", "/sub"),
        (ServiceCalls(trace(graph=without("/add", services(Add=TYPE))), ()), "wrong service name", "/Add"),
        (
            ServiceCalls(
                trace(graph=without("/add", services(node__set_parameters="rcl_interfaces/srv/SetParameters"))), ()
            ),
            "service missing",
            "/add",
        ),
        (ServiceCalls(SERVING, (called("/add", 6, 3, None),), spins=False), "no spin", "/node"),
        (ServiceCalls(SERVING, (called("/add", 6, 3, None),), stuck=IN_CALL), "deadlock by call()", "line 12"),
        (
            ServiceCalls(SERVING, (called("/add", 6, 3, None),), stuck=(frame("add"), EXECUTING)),
            "blocked executor",
            "line 12",
        ),
        (ServiceCalls(SERVING, (*ANSWERS[:3], called("/divide", 6, 3, None))), "no answer", "/divide"),
        (
            ServiceCalls(trace(graph=ALL, err=CRASH, exit=exited(1)), (called("/add", 6, 3, None),), ready=False),
            "unhandled exception",
            "",
        ),
        (ServiceCalls(SERVING, ()), "service missing", "/add"),
        (ServiceCalls(SERVING, ANSWERS[:3]), "service missing", "/divide"),
    ],
)
def test_services_fail(seen: ServiceCalls, cause: str, word: str) -> None:
    assert_failed(judge_services(seen), cause, word)


@pytest.mark.parametrize("last", [2, None, -1])
def test_a_server_that_a_call_ends_is_told_by_operations_whether_the_answer_got_out_or_not(last: int | None) -> None:
    dead = trace(graph=ALL, err=CRASH, exit=exited(1))
    seen = ServiceCalls(dead, (*ANSWERS[:3], called("/divide", 6, 3, last)))
    assert_skipped(judge_services(seen), "`operations` shows why")
    assert_failed(
        judge_operations_after(ServiceCalls(dead, (called("/divide", 60, 3, None),)), seen), "unhandled exception"
    )
    good = called("/divide", 84, 7, last)
    assert_skipped(judge_division(CallsAroundBad(dead, good)), "`operations` shows why")
    assert_skipped(judge_division(CallsAroundBad(dead, good, (good, called("/divide", 84, 7, None)))), "`operations`")


def test_a_service_of_the_wrong_type_is_missing() -> None:
    assert missing_services(ALL.servers) == []
    assert missing_services(services(add=TYPE, subtract="a/srv/B").servers) == ["/subtract", "/multiply", "/divide"]


operands = st.tuples(
    st.sampled_from(list(OPERATOR_SIGNS)), st.integers(-1000, 1000), st.integers(-20, 20).filter(bool)
).map(lambda each: (each[0], each[1] * each[2] if each[0] == "/divide" else each[1], each[2]))
one_of_each = st.tuples(
    *(operands.map(lambda each, s=service: right_answer(s, each[2] * 7, each[2])) for service in OPERATOR_SIGNS)  # type: ignore[misc]
)


@given(one_of_each, st.lists(operands.map(lambda each: right_answer(*each))))
def test_right_results_pass(each: tuple[CallAnswer, ...], more: list[CallAnswer]) -> None:
    assert_passed(judge_operations(ServiceCalls(SERVING, (*each, *more))))


@given(operands, st.integers(), st.lists(operands.map(lambda each: right_answer(*each)), max_size=5))
def test_any_wrong_result_fails(asked: tuple[str, int, int], result: int, before: list[CallAnswer]) -> None:
    service, a, b = asked
    if result != correct_result(service, a, b):
        verdict = judge_operations(ServiceCalls(SERVING, (*ANSWERS, *before, called(service, a, b, result))))
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
    others = [each for each in ANSWERS if each.service != service]
    seen = ServiceCalls(SERVING, (*others, *(called(service, *each) for each in results)))
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
        for name, other in zip(OPERATOR_SIGNS, computes, strict=True)
        for a, b in ((20, 4), (-21, 7))
    ]
    run = trace(graph=ALL, sources={"node.py": text})
    assert_failed(judge_operations(ServiceCalls(run, tuple(answers))), cause)


def test_an_exception_in_a_callback_is_named() -> None:
    seen = ServiceCalls(trace(graph=ALL, err=CRASH, exit=exited(1)), (called("/add", 1, 2, None),))
    assert_failed(judge_operations(seen), "unhandled exception", "self.nothing()")


@pytest.mark.parametrize(
    "seen",
    [
        ServiceCalls(trace(graph=NODE_UP), ()),
        ServiceCalls(trace(graph=without("/add", NODE_UP)), ANSWERS[1:]),
        ServiceCalls(trace(graph=ALL), (called("/add", 6, 3, None),)),
        ServiceCalls(CRASHED, ()),
    ],
)
def test_operations_are_skipped_if_services_failed(seen: ServiceCalls) -> None:
    assert_skipped(judge_operations_after(ServiceCalls(SERVING, ANSWERS), seen), "`services` did not pass")


@pytest.mark.parametrize("answers", [(), ANSWERS[:3]])
def test_operations_fail_if_a_service_was_not_called(answers: tuple[CallAnswer, ...]) -> None:
    assert_failed(judge_operations(ServiceCalls(SERVING, answers)), "service missing", "/divide")


# --- division by zero --------------------------------------------------------

INCOMING = "Incoming request: a={} b={}"
ORDINARY = (log("calculator ready"), log(INCOMING.format(84, 7)), log("84 / 7 = 12"))


def after_zero(*results: int | None) -> tuple[CallAnswer, ...]:
    """The answers to the calls after a division by zero."""
    return tuple(called("/divide", a, b, result) for (a, b), result in zip(DIVISIONS_AFTER_ZERO, results, strict=False))


def division(
    *logged: LogRecord,
    by_zero: int | None = 0,
    after: tuple[CallAnswer, ...] = after_zero(6, 0, 0, 7),
    seen: Trace = SERVING,
    before: int | None = 12,
) -> CallsAroundBad:
    good = called("/divide", 84, 7, before)
    return CallsAroundBad(
        seen,
        good,
        (good, good),
        None if before is None else called("/divide", 10, 0, by_zero),
        after,
        ORDINARY,
        logged,
    )


ERRORS = [
    "Division by zero!",
    "cannot divide 10 by 0",
    "b must be other than 0: invalid request",
    "Division durch Null",
    "Fehler: b ist 0",
    "nicht möglich",
    "división por cero",
    "error: no se puede dividir",
    "division par zéro impossible",
    "divisione per zero",
    "divisão por zero",
    "deling door nul",
    "dělení nulou: chyba",
    "dzielenie przez zero",
    "деление на ноль",
    "на ноль делить нельзя",
    "不能除以零",
    "除数不可为 0",
    "ゼロ除算エラー",
    "0으로 나눌 수 없습니다",
    "sıfıra bölme hatası",  # noqa: RUF001
    "διαίρεση με μηδέν",
    "القسمة على صفر",
    "חלוקה באפס",
    "शून्य से भाग",
    "lỗi chia cho 0",
    "kesalahan",
    "result: nan",
    "ZeroDivisionError",
    "Division by 0!",
    "b must not be 0",
    "You can\u2019t divide by that",
    "b = 0: won't do that",
    "has to be non-zero",
    "status=DIV_BY_0",
    "#DIV/0!",
    "[ERR] divide",
    "Oops! The divisor is 0.",
    "❌ 10 / 0",
    "⚠️ b",
    "Achtung: Nenner ist 0",
    "Division durch 0",
    "Durch 0 teile ich auf keinen Fall",
    "No es posible dividir entre 0",
    "On ne peut pas diviser par 0",
    "Non si divide per 0",
    "Delen door 0 kan niet",
    "Kan inte dividera med 0",
    "Man kan ikke dividere med 0",
    "Nie można dzielić przez 0",
    "Nelze dělit 0",
    "Nije moguće dijeliti s 0",
    "0-val nem lehet osztani",
    "0 ile bölünemez",
    "Делить на ноль не умею",
    "Không thể chia cho 0",
    "tidak bisa dibagi nol",
    "لا يمكن القسمة على 0",
    "Operation aborted (b=0)",
    "Cancelled: b=0",
    "Bad request: b=0",
    "BadRequest",
    "bad_input",
    "wrong input: b=0",
    "Wrong divisor",
    "Denied: 10/0",
    "DENY",
    "prohibited",
    "disallowed",
    "unsupported operation 10 / 0",
    "unacceptable",
    "Fault: b=0",
    "halted",
    "ignoring 10/0",
    "ignored: 10/0",
    "unsuccessful",
    "success=False, result=0",
    '{"op": "divide", "ok": false, "status": -1}',
    "x/0 has no defined result",
    "10 / 0 -> no result",
    "10 / 0 = undef",
    "10/0 indeterminate",
    "mathematically meaningless",
    "10 / 0 = ∞",
    "10 / 0: overflow",
    "out of domain",
    "b must be != 0",
    "b ≠ 0",
    "divisor must be different from 0",
    "anything but 0",
    "status=ERR_DIV",
    "DIV_ERR",
    "Sorry, b=0",
]


NO_ERRORS = [
    "10 / 0 = 0",
    INCOMING.format(10, 0),
    "10 / 0 = inf",
    "request",
    "b is 0",
    "",
    "Dividing 10 by 0",
    "10 divided by 0 = 0",
    "Rechne 10 geteilt durch 0",
    "DIVIDE 10 0 -> 0",
    "Request no 3: 10 / 0",
    "Note: the result is 0",
    "one more division: 0",
    "delivered 0",
    "by default: 0",
    "badge 10, 0",
    "Inhalt: 10 / 0 = 0",
    "success: 10 / 0 = 0",
    '{"op": "divide", "ok": true, "result": 0}',
    "success=True, result=0",
    "result no 10: 0",
    "verrechnet: 10 / 0 = 0",
]


@pytest.mark.parametrize("text", ERRORS)
def test_an_error_is_understood_in_many_languages(text: str) -> None:
    assert_passed(judge_division(division(log(INCOMING.format(10, 0)), log(text))))
    assert_passed(judge_division(division(log(text.upper()))))


@pytest.mark.parametrize("level", [30, 40, 50])
def test_a_warning_needs_no_particular_words(level: int) -> None:
    assert_passed(judge_division(division(log("b = 0", level))))


@pytest.mark.parametrize("text", NO_ERRORS)
def test_an_ordinary_message_is_not_an_error(text: str) -> None:
    assert_failed(judge_division(division(log(text))), "not logged")


@given(st.sampled_from(ERRORS), st.sampled_from([10, 20, 30, 40]), st.integers(), st.integers())
def test_what_is_also_logged_for_a_valid_call_is_not_a_complaint(text: str, level: int, usual: int, now: int) -> None:
    assert find_complaints([log(f"{text} {usual}", level)], [log(f"{text} {now}", level)]) == []


@given(st.sampled_from(ERRORS), st.lists(st.sampled_from(ORDINARY)))
def test_an_error_is_found_among_other_messages(text: str, around: list[LogRecord]) -> None:
    assert find_complaints(ORDINARY, [*around, log(text), *around]) == [log(text)]


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (CallsAroundBad(CRASHED), "unhandled exception", "84"),
        (CallsAroundBad(trace(graph=NODE_UP)), "no answer", "84"),
        (division(before=None), "no answer", "84"),
        (division(by_zero=None), "no answer", "10 ÷ 0"),
        (division(by_zero=None, seen=trace(err=CRASH, exit=exited(1))), "unhandled exception", "line 12"),
        (division(), "not logged", "nothing that the node logs"),
        (division(before=588), "not logged", "84 ÷ 7 is answered 588"),
        (division(seen=trace(graph=ALL, out="error: division by zero")), "printed, not logged", "print()"),
        (
            division(log("division by zero", 40), after=after_zero(None)),
            "no answer",
            "after a division by zero",
        ),
        (division(log("division by zero", 40), after=after_zero(6, None)), "no answer", "-9 ÷ 0"),
        (division(log("division by zero", 40), after=after_zero(6, 0, None)), "no answer", "0 ÷ 0"),
        (division(log("division by zero", 40), after=after_zero(6, 0, 0, None)), "no answer", "35 ÷ 5"),
        (
            division(log("division by zero", 40), after=after_zero(0, 0, 0, 7)),
            "wrong answer",
            "18 ÷ 3 was answered 0",
        ),
        (
            division(log("division by zero", 40), after=after_zero(6, 0, 0, 0)),
            "wrong answer",
            "35 ÷ 5 was answered 0",
        ),
        (
            division(log("division by zero", 40), after=after_zero(None), seen=trace(exit=exited(0, after_s=9.0))),
            "exit at once",
            "18 ÷ 3",
        ),
        (division(after=after_zero(None), seen=trace(exit=exited(0, after_s=9.0))), "exit at once", "18 ÷ 3"),
        (division(seen=trace(exit=exited(0, after_s=9.0))), "exit at once", ""),
    ],
)
def test_division_fails(seen: CallsAroundBad, cause: str, word: str) -> None:
    assert_failed(judge_division(seen), cause, word)


@pytest.mark.parametrize("results", [(6, 0, 0, 7), (6, -1, 99, 7)])
def test_any_answer_to_a_division_by_zero_passes(results: tuple[int, ...]) -> None:
    assert_passed(judge_division(division(log("division by zero", 40), after=after_zero(*results))))


def test_wrong_division_in_general_is_not_judged_here() -> None:
    assert_passed(judge_division(division(log("division by zero", 40), before=13, after=after_zero(7, 0, 0, 8))))


def test_operands() -> None:
    chosen = random_operands()
    assert {(a > 0, b > 0) for a, b in chosen if a} == {(True, True), (True, False), (False, True), (False, False)}
    assert [a for a, _ in chosen].count(0) == 1
    assert any(abs(a) > 2**32 for a, _ in chosen)
    for a, b in chosen:
        assert b != 0 == a % b
        assert max(abs(correct_result(service, a, b)) for service in OPERATOR_SIGNS) < 2**53


# --- the client --------------------------------------------------------------

SERVED = tuple(
    ServedRequest(name, {"a": 10, "b": 5}, {"sum": correct_result(name, 10, 5)}, 1001.0) for name in OPERATOR_SIGNS
)


def demonstration(
    served: tuple[ServedRequest, ...] = SERVED, code: int | None = 0, stuck: tuple[Frame, ...] = (), **more: Any
) -> ClientRun:
    ended = None if code is None else exited(code)
    return ClientRun(trace(exit=ended, **more), served, ended, stuck)


@pytest.mark.parametrize("served", [SERVED, SERVED * 3, tuple(reversed(SERVED))])
def test_client_passes(served: tuple[ServedRequest, ...]) -> None:
    assert_passed(judge_client(demonstration(served)))


@pytest.mark.parametrize(
    ("served", "code", "cpu_wait_s", "retried"),
    [
        ((), 1, 0.1, False),
        ((), 1, 0.2, True),  # it may have looked for the servers before the busy machine let us start them
        (SERVED[:1], 1, 0.2, False),
        ((), None, 0.2, False),  # it had its full 15 s
        ((), None, 2.5, True),
    ],
)
def test_a_client_is_retried_if_the_machine_may_be_why_it_called_nothing(
    served: tuple[ServedRequest, ...], code: int | None, cpu_wait_s: float, retried: bool
) -> None:
    assert replace(demonstration(served, code), cpu_wait_s=cpu_wait_s).slowed is retried


def test_a_client_that_can_never_connect_is_not_retried() -> None:
    unconnected = (ServiceEndpoint("/add", "example_interfaces/srv/AddTwoInts", "/client", "best_effort"),)
    assert not replace(demonstration((), 1), cpu_wait_s=2.5, clients=unconnected).slowed


@pytest.mark.parametrize(
    ("test", "cause"),
    [("if answer.sum:", "zero is false"), ("while not result:", "zero is false"), ("if answer.ok:", "calls missing")],
)
def test_a_client_that_takes_zero_for_no_result(test: str, cause: str) -> None:
    source = f"def ask(self, answer):\n    result = answer.sum\n    {test}\n        self.next()\n"
    zero = replace(SERVED[1], request={"a": 5, "b": 5}, response={"sum": 0})
    hanging = demonstration((SERVED[0], zero, zero), None)
    assert hanging.trace is not None
    assert_failed(judge_client(replace(hanging, trace=replace(hanging.trace, sources={"node.py": source}))), cause)


def test_a_client_that_waits_in_vain_is_reported_with_the_time_that_it_was_watched() -> None:
    hanging = demonstration(SERVED[:1], None)
    assert "still running after 15 s" in judge_client(hanging).observed
    assert (
        "after 6.2 s it still runs, and nothing more comes from it; called "
        in judge_client(replace(hanging, watched_s=6.2)).observed
    )


@pytest.mark.parametrize(
    ("seen", "cause", "word"),
    [
        (ClientRun(None), "file missing", "calculator_client.py"),
        (demonstration(SERVED[:3]), "calls missing", "/divide"),
        (demonstration(()), "calls missing", "/add, /subtract, /multiply, /divide"),
        (demonstration((), sources={"node.py": "def main():\n    ask()\n"}), "no main call", "nothing calls it"),
        (demonstration(code=1), "non-zero exit", "exit code 1"),
        (demonstration((), code=1, err=CRASH), "unhandled exception", "called nothing"),
        (demonstration(SERVED[:1], code=None, stuck=IN_CALL), "deadlock by call()", "called /add"),
        (demonstration(SERVED, code=None, stuck=(frame("ask"),)), "did not end", "line 12"),
        (demonstration(SERVED, code=None), "did not end", "by itself"),
    ],
)
def test_client_fails(seen: ClientRun, cause: str, word: str) -> None:
    assert_failed(judge_client(seen), cause, word)


ASKS = """
node = rclpy.create_node('client')
client = node.create_client(AddTwoInts, 'add')
future = client.call_async(AddTwoInts.Request(a=1, b=2))
"""
WAITS = ASKS.replace("future =", "client.wait_for_service(timeout_sec=0.1)\nfuture =")
MADE = (ServiceEndpoint("/add", TYPE, "/client"),)
SPINNING = (frame("spin_once", "/venv/rclpy/executors.py"), frame("main"))
NO_ANSWER = CRASH.replace("'Sensor' object has no attribute 'nothing'", "'NoneType' object has no attribute 'sum'")


def asking(text: str, served: tuple[ServedRequest, ...] = (), code: int | None = 0, **more: Any) -> ClientRun:
    """A run of a client with this source."""
    return replace(demonstration(served, code, sources={"node.py": text}, **more), clients=MADE)


@pytest.mark.parametrize(
    "seen",
    [
        asking(ASKS),
        asking(ASKS, SERVED[1:]),
        asking(ASKS, code=1),
        asking(ASKS, code=1, err=NO_ANSWER),
        asking(ASKS, code=None, stuck=SPINNING),
        asking(ASKS, code=None, stuck=(*IN_CALL, *SPINNING)),
    ],
)
def test_a_client_that_does_not_wait_for_its_service(seen: ClientRun) -> None:
    assert_failed(judge_client(seen), "service not waited for", "line 4", "Wait for the service before")


@pytest.mark.parametrize("text", ["client.wait_for_service()", "self.cli.service_is_ready()"])
def test_a_client_that_waits_for_its_service_is_not_told_to_wait(text: str) -> None:
    for seen in (asking(ASKS + text, SERVED[:1]), asking(ASKS + text, SERVED[:1], None, stuck=SPINNING)):
        assert "not waited" not in explained(judge_client(seen), CHECK).cause


NAMED = """
node = rclpy.create_node('client')
for name in ('add', 'subtract', 'multiply', 'div'):
    client = node.create_client(AddTwoInts, name)
"""


def wrongly_named(text: str, *clients: ServiceEndpoint, code: int | None = None) -> ClientRun:
    seen = demonstration(SERVED[:3], code, stuck=SPINNING, sources={"node.py": text + WAITS})
    return replace(seen, clients=(*MADE, *clients))


@pytest.mark.parametrize("code", [None, 0, 1])
def test_a_wrong_service_name_in_the_client_is_reported_with_the_right_one(code: int | None) -> None:
    seen = wrongly_named(NAMED, ServiceEndpoint("/div", TYPE, "/client"), code=code)
    assert_failed(
        judge_client(seen),
        "service not offered",
        "asks for /div, which nobody offers; there is /divide",
    )


@pytest.mark.parametrize(
    ("name", "difference"),
    [("/client/divide", "the node's name is in front"), ("/Divide", "upper and lower case"), ("/modulo", "spelled")],
)
def test_a_wrong_service_name_in_the_client_is_told_by_how_it_differs(name: str, difference: str) -> None:
    seen = wrongly_named("", ServiceEndpoint(name, TYPE, "/client"))
    assert_failed(judge_client(seen), "service not offered", f"asks for {name},", difference)


def test_a_client_of_a_parameter_service_is_not_a_wrong_name() -> None:
    more = ServiceEndpoint("/server/get_parameters", "rcl_interfaces/srv/GetParameters", "/client")
    assert_failed(judge_client(wrongly_named(NAMED, more)), "client overwritten in a loop")
    assert_passed(judge_client(replace(demonstration(), clients=(*MADE, ServiceEndpoint("/power", TYPE, "/client")))))


def test_a_wrong_service_type_in_the_client_is_reported_with_the_right_one() -> None:
    text = "\nclient = node.create_client(Trigger, 'divide')\nclient.call_async(Trigger.Request())"
    seen = wrongly_named(text, ServiceEndpoint("/divide", "std_srvs/srv/Trigger", "/client"))
    assert_failed(judge_client(seen), "service not offered", "with the type std_srvs/srv/Trigger", TYPE)


LOOP = """
def run(self):
    for name in NAMES:
        client = self.create_client(AddTwoInts, name)
        client.wait_for_service()
        future = client.call_async(AddTwoInts.Request())
        rclpy.spin_until_future_complete(self, future)
        return future.result().sum

run()
"""


def test_a_coroutine_that_is_not_awaited() -> None:
    warning = "/ws/client.py:27: RuntimeWarning: coroutine 'CalculatorClient.call' was never awaited"
    seen = asking(WAITS, err=warning)
    assert_failed(judge_client(seen), "coroutine not awaited", "call is an async def")


def test_a_return_within_the_loop() -> None:
    assert_failed(
        judge_client(asking(LOOP, SERVED[:1])),
        "return in the loop",
        "line 8",
        "the loop in line 3",
    )
    assert_failed(judge_client(asking(LOOP.replace("return", "print"), SERVED[:1])), "calls missing")
    assert_failed(judge_client(asking(LOOP, SERVED[:3])), "calls missing")


def test_a_spin_after_the_last_call() -> None:
    spins = (frame("spin", "/venv/rclpy/__init__.py"), frame("main", line=7, code="rclpy.spin(node)"))
    text = WAITS + "rclpy.spin_until_future_complete(node, future)\nrclpy.spin(node)\n"
    assert_failed(judge_client(asking(text, SERVED, None, stuck=spins)), "spin never returns", "line 7")


THREADING = "/usr/lib/python3.12/threading.py"


@pytest.mark.parametrize(
    ("text", "code", "stuck", "cause"),
    [
        ("while not future.done():\n    time.sleep(0.1)", None, (), "no spin for the answer"),
        ("while not future.done():\n    time.sleep(0.1)", 1, (), "no spin for the answer"),
        ("while not future.done():\n    rclpy.spin_once(node)", None, (), "calls missing"),
        ("Thread(target=rclpy.spin, args=(node,)).start()\nwhile not future.done(): pass", None, (), "calls missing"),
        ("while client.wait_for_service(1.0):\n    pass", None, SPINNING, "wait turned around"),
        (
            "done = threading.Event()\nrclpy.spin",
            None,
            (frame("wait", THREADING), frame("main", line=6, code="done.wait()")),
            "event never set",
        ),
        (
            "done = threading.Event()\nuse(rclpy.spin)\ndone.set()",
            None,
            (frame("wait", THREADING), frame("main", line=6, code="done.wait()")),
            "calls missing",
        ),
        (
            "answered = asyncio.Event()\nfuture.add_done_callback(lambda done: answered.set())",
            None,
            (),
            "event loop not woken",
        ),
        ("rclpy.spin\nfor n in nodes:\n    rclpy.spin_once(n)", None, (), "spin_once waits"),
        ("use(rclpy.spin)\nnode.create_timer(500, ask)", None, (), "wrong timer period"),
    ],
)
def test_a_client_that_gets_no_answer(text: str, code: int | None, stuck: tuple[Frame, ...], cause: str) -> None:
    assert_failed(judge_client(asking(WAITS + text, SERVED[:1], code, stuck=stuck)), cause)


@pytest.mark.parametrize("function", ["join", "_shutdown"])
def test_a_thread_that_keeps_the_client_from_ending(function: str) -> None:
    stuck = (frame(function, THREADING), frame("main", line=9, code="thread.join()"))
    assert_failed(judge_client(asking(WAITS, SERVED, None, stuck=stuck)), "thread never ends", "line 9")


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


def test_a_future_polled_in_a_callback_of_the_clients_own_group() -> None:
    run = trace(graph=ALL, sources={"node.py": POLLING})
    polling = (frame("subtract", line=12, code="time.sleep(0.1)"), EXECUTING)
    pool = frame("run", "/usr/lib/python3.12/concurrent/futures/thread.py")
    silent = (called("/subtract", 6, 3, None),)
    for stuck, busy in ((polling, "the executor"), ((*polling, pool), "its callback group"), ((), "the executor")):
        verdict = judge_services(ServiceCalls(run, silent, stuck=stuck))
        assert_failed(verdict, "polls a future", "waits for future", f"keeps {busy} busy")


def test_an_error_that_good_divisions_log_as_well_is_none() -> None:
    seen = replace(division(log("error", 40)), ordinary=(log("error", 40),))
    assert_failed(judge_division(seen), "the same message for every call", "in the same words", ": error")


def test_an_unrelated_crash_is_reported_as_such() -> None:
    assert_failed(judge_client(asking(ASKS, code=1, err=CRASH)), "unhandled exception", "line 12")


def test_a_client_that_gives_up_before_the_server_is_up() -> None:
    assert_failed(judge_client(asking(WAITS, code=1)), "waits too short a time", "Wait longer")
    assert_failed(judge_client(asking(WAITS, code=1, err=NO_ANSWER)), "waits too short a time")
    assert_failed(judge_client(asking(WAITS, code=1, err=CRASH)), "unhandled exception")
    usage = replace(asking(WAITS + "if len(sys.argv) < 2:\n    sys.exit(2)", code=2), clients=())
    assert_failed(judge_client(usage), "needs arguments", "line 6")


def test_shutdown() -> None:
    assert_passed(judge_shutdown(ServiceCalls(SERVING, ANSWERS, ending=ending(0))))
    assert_passed(judge_shutdown(ServiceCalls(SERVING, ANSWERS, ending=ending(130))))
    assert_failed(judge_shutdown(ServiceCalls(SERVING, ANSWERS, ending=ending(still_running=True))), "does not end")
    assert_skipped(judge_shutdown(ServiceCalls(CRASHED, ())), "`services` shows why")
    assert_skipped(judge_shutdown(ServiceCalls(trace(graph=ALL, exit=exited(1)), ANSWERS)), "`operations` shows why")


def test_a_server_that_sleeps_instead_of_spinning_is_told_to_spin() -> None:
    text = "import time\nimport rclpy\nrclpy.init()\nnode = rclpy.create_node('c')\nwhile True:\n    time.sleep(0.2)\n"
    run = trace(graph=ALL, sources={"node.py": text})
    sleeping = (frame("<module>", line=6, code="time.sleep(0.2)"),)
    verdict = judge_services(ServiceCalls(run, (called("/add", 6, 3, None),), spins=False, stuck=sleeping))
    assert_failed(verdict, "no spin", "line 6")
