"""Exceptions of which only the message is logged."""

from __future__ import annotations

import pytest

from tutor.judge.symptom import Symptom
from tutor.judge.trace import LogRecord, OutputLine, Trace
from tutor.mistakes import CATALOGUE, Case
from tutor.mistakes.diagnosis import Diagnosis, describe

CALLBACK = """
def callback(self, request, response):
    try:
        response.result = request.a + request.b
        self.get_logger().info(str(response.result))
    except {}:
        self.get_logger().error(f'failed: {{error}}')
    return response
"""
MESSAGE = "'AddTwoInts_Response' object has no attribute 'result'"
READ_TOO_EARLY = """\
def main():
    try:
        print("name of the sensor", "name")
        name = node.get_parameter("name").value
        node.declare_parameter("name", "a")
    except Exception as error:
        node.get_logger().error(f"no: {error}")
"""


def trace(source: str, *, logged: str = "", printed: str = "") -> Trace:
    logs = (LogRecord(40, "node", logged, 1.0, 1.0),) if logged else ()
    output = (OutputLine("stdout", printed, 1.0),) if printed else ()
    return Trace("node.py", "/home/me", sources={"node.py": source}, logs=logs, output=output)


def diagnosis(seen: Trace) -> Diagnosis | None:
    entry, case = CATALOGUE.entries["exception-only-logged"], Case(Symptom.WRONG_ANSWER.seen(seen))
    return next((describe(entry, found, case) for found in entry.find(case)), None)


@pytest.mark.parametrize("handler", ["Exception as error", "(ValueError, AttributeError) as error"])
def test_the_line_that_assigns_is_named(handler: str) -> None:
    source = CALLBACK.format(handler)
    for seen in (trace(source, logged=f"failed: {MESSAGE}"), trace(source, printed=f"failed: {MESSAGE}")):
        found = diagnosis(seen)
        assert found is not None
        assert found.line == 4
        assert "has no field result; it has sum" in found.cause
        assert found.step == "Use sum there."


def test_an_undefined_name_is_found() -> None:
    source = "def callback(self):\n    try:\n        sleep(3)\n    except:\n        traceback.print_exc()\n"
    found = diagnosis(trace(source, logged="name 'sleep' is not defined"))
    assert found is not None
    assert found.line == 3


def test_a_parameter_that_is_read_too_early_is_found_where_it_is_read() -> None:
    found = diagnosis(trace(READ_TOO_EARLY, logged="no: Invalid access to undeclared parameter(s): name"))
    assert found is not None
    assert "name is read before line 5 declares it" in found.cause
    assert found.line == 4


@pytest.mark.parametrize(
    ("source", "logged"),
    [
        (CALLBACK.format("ValueError as error"), f"failed: {MESSAGE}"),  # it would not be caught
        (CALLBACK.format("Exception as error"), "failed: division by zero"),  # perhaps as requested
        (CALLBACK.format("Exception as error"), "'Other' object has no attribute 'elsewhere'"),
        ("this is no Python", MESSAGE),
    ],
)
def test_anything_else_is_left_alone(source: str, logged: str) -> None:
    assert diagnosis(trace(source, logged=logged)) is None
