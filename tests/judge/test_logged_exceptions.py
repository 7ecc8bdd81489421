"""Exceptions of which only the message is logged."""

from __future__ import annotations

import pytest

from tutor.judge.causes.logged_exceptions import diagnose_logged_exception
from tutor.judge.trace import LogRecord, OutputLine, Trace

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


def trace(source: str, *, logged: str = "", printed: str = "") -> Trace:
    logs = (LogRecord(40, "node", logged, 1.0, 1.0),) if logged else ()
    output = (OutputLine("stdout", printed, 1.0),) if printed else ()
    return Trace("node.py", "/home/me", sources={"node.py": source}, logs=logs, output=output)


@pytest.mark.parametrize("handler", ["Exception as error", "(ValueError, AttributeError) as error"])
def test_the_line_that_assigns_is_named(handler: str) -> None:
    source = CALLBACK.format(handler)
    for seen in (trace(source, logged=f"failed: {MESSAGE}"), trace(source, printed=f"failed: {MESSAGE}")):
        found = diagnose_logged_exception(seen)
        assert found is not None
        assert "line 4" in found.text
        assert "response.sum = request.a + request.b" in found.hint


def test_an_undefined_name_is_found() -> None:
    source = "def callback(self):\n    try:\n        sleep(3)\n    except:\n        traceback.print_exc()\n"
    found = diagnose_logged_exception(trace(source, logged="name 'sleep' is not defined"))
    assert found is not None
    assert "line 3" in found.text


def test_a_parameter_that_is_read_too_early_is_found_where_it_is_read() -> None:
    source = """\
def main():
    try:
        print("name of the sensor", "name")
        name = node.get_parameter("name").value
        node.declare_parameter("name", "a")
    except Exception as error:
        node.get_logger().error(f"no: {error}")
"""
    found = diagnose_logged_exception(trace(source, logged="no: Invalid access to undeclared parameter(s): name"))
    assert found is not None
    assert "name is read before line 5 declares it" in found.text
    assert found.hint.startswith("write above line 4")


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
    assert diagnose_logged_exception(trace(source, logged=logged)) is None
