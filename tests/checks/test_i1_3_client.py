"""I1.3: verdicts on fabricated runs of the calculator's client."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from checks.i1_3_calculator_service import CHECK, TYPE
from tests.checks.builders import CRASH, assert_passed, exited, explained, frame, judge_of, trace
from tests.checks.calculator import COMPUTES, IN_CALL, assert_failed, correct_result
from tutor.exercise.client_run import ClientRun
from tutor.judge.trace import ServedRequest
from tutor.judge.tracebacks import Frame
from tutor.ros_model import ServiceEndpoint

judge_client = judge_of(CHECK, "client")

SERVED = tuple(
    ServedRequest(name, {"a": 10, "b": 5}, {"sum": correct_result(name, 10, 5)}, 1001.0) for name in COMPUTES
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


def test_an_unrelated_crash_is_reported_as_such() -> None:
    assert_failed(judge_client(asking(ASKS, code=1, err=CRASH)), "unhandled exception", "line 12")


def test_a_client_that_gives_up_before_the_server_is_up() -> None:
    assert_failed(judge_client(asking(WAITS, code=1)), "waits too short a time", "Wait longer")
    assert_failed(judge_client(asking(WAITS, code=1, err=NO_ANSWER)), "waits too short a time")
    assert_failed(judge_client(asking(WAITS, code=1, err=CRASH)), "unhandled exception")
    usage = replace(asking(WAITS + "if len(sys.argv) < 2:\n    sys.exit(2)", code=2), clients=())
    assert_failed(judge_client(usage), "needs arguments", "line 6")
