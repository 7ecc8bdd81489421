"""Callbacks that ask another service: what the catalogue says of them, and what it must not say."""

from __future__ import annotations

from typing import Any

import pytest

from tests.checks.builders import trace
from tests.mistakes.cases import assert_told, told
from tutor.judge.symptom import Symptom
from tutor.ros_model import Graph, ServiceEndpoint

ASYNC = """\
class Bell(Node):
    def __init__(self):
        self.door = self.create_client(Trigger, 'open'{client})
        self.create_service(Trigger, 'ring', self.on_bell{service})

    async def on_bell(self, request, response):
        return await self.door.call_async(request)
"""
GROUPED = ASYNC.replace("        self.door", "        self.g = MutuallyExclusiveCallbackGroup()\n        self.door")
OWN = ", callback_group=MutuallyExclusiveCallbackGroup()"
OF_BELL = ", callback_group=self.g"
BLOCKS = """\
class Bell(Node):
    def __init__(self):
        self.create_service(Trigger, 'ring', self.on_bell)

    def on_bell(self, request, response):
        {}

executor = MultiThreadedExecutor({})
"""
MISSING: dict[str, Any] = {"ours": "missing", "asks": "/open", "services": ("/ring",)}
SILENT: dict[str, Any] = {"ours": "silent", "asks": "/open", "asked": True}

CLIENT = trace(graph=Graph(("/bell",), clients=(ServiceEndpoint("/open", "std_srvs/srv/Trigger", "/b"),)))


@pytest.mark.parametrize(
    ("source", "mistake"),
    [
        (ASYNC.format(client="", service=""), "deadlock-by-await"),
        (ASYNC.format(client=OWN, service=""), "no-answer"),
        (ASYNC.format(client="", service=OWN), "no-answer"),
        (GROUPED.format(client=OF_BELL, service=OF_BELL), "deadlock-by-await"),
        (GROUPED.format(client=OF_BELL, service=""), "no-answer"),
        (GROUPED.replace("MutuallyExclusive", "Reentrant").format(client=OF_BELL, service=OF_BELL), "no-answer"),
        (f"{GROUPED.format(client=OF_BELL, service=OF_BELL)}r = ReentrantCallbackGroup()", "deadlock-by-await"),
    ],
)
def test_an_await_locks_only_in_the_clients_own_group(source: str, mistake: str) -> None:
    assert_told(told(Symptom.NO_ANSWER, source, asks="/open", asked=True, replied=True), mistake)


@pytest.mark.parametrize(
    ("statement", "about", "mistake", "words"),
    [
        ("self.door.call(request)", MISSING, "asked-without-looking", "line 6 asks /open"),
        ("self.door.wait_for_service(); self.door.call(request)", MISSING, "waits-for-a-service", "line 6"),
        ("self.door.wait_for_service(1.0); self.door.call(request)", MISSING, "no-answer", ""),
        ("self.door.call(request)", SILENT, "no-limit-to-a-wait", "line 6"),
        ("self.door.call(request)", {**SILENT, "asked": False}, "no-answer", ""),
        ("self.door.call(request)", {**SILENT, "replied": True}, "no-answer", ""),
        ("self.door.call(request)", {"at_once": 2, "replied": True}, "threads-all-waiting", "line 8"),
        ("self.door.call(request)", {"at_once": 1, "replied": True}, "no-answer", ""),
    ],
)
def test_why_a_call_is_not_answered(statement: str, about: dict[str, Any], mistake: str, words: str) -> None:
    found = told(Symptom.NO_ANSWER, BLOCKS.format(statement, 2), run=CLIENT, **about)
    assert_told(found, mistake, words)


def test_a_limit_whose_timer_is_in_the_group_of_the_wait() -> None:
    source = ASYNC.format(client=OWN, service="").replace(
        "return await self.door.call_async(request)",
        "asked = self.door.call_async(request)\n        self.create_timer(3.0, asked.cancel)\n        await asked",
    )
    found = told(Symptom.NO_ANSWER, source, **SILENT)
    assert_told(found, "no-limit-to-a-wait", "line 8 is to end the wait for /open, and is in the callback group")


def test_enough_threads_do_not_all_wait() -> None:
    found = told(Symptom.NO_ANSWER, BLOCKS.format("self.door.call(request)", 4), at_once=2, replied=True)
    assert_told(found, "no-answer")


@pytest.mark.parametrize(
    ("statement", "mistake"),
    [
        ("return self.door.call(request, timeout_sec=2.0)", "limit-runs-out-each-time"),
        ("rclpy.spin_until_future_complete(self, self.door.call_async(request))", "spin-inside-a-callback"),
        ("return response", "wrong-answer"),
    ],
)
def test_a_limit_that_always_runs_out(statement: str, mistake: str) -> None:
    assert_told(told(Symptom.WRONG_ANSWER, BLOCKS.format(statement, 4), given_up=True), mistake)


def test_a_wrong_answer_that_was_not_given_up_has_another_reason() -> None:
    source = BLOCKS.format("return self.door.call(request, timeout_sec=2.0)", 4)
    assert_told(told(Symptom.WRONG_ANSWER, source), "wrong-answer")
