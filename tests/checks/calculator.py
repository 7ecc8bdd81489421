"""I1.3: what could be observed of a calculator."""

from __future__ import annotations

from functools import partial

from checks.i1_3_calculator_service import CHECK, SERVICES, TYPE
from tests.checks import builders
from tests.checks.builders import called, frame, graph, trace
from tutor.judge.trace import CallAnswer

assert_failed = partial(builders.assert_failed, check=CHECK)

COMPUTES = {service.name: service.computes for service in SERVICES}
ALL = graph(services=dict.fromkeys(COMPUTES, TYPE))
SERVING = trace(graph=ALL)
IN_CALL = (frame("wait", "/usr/lib/python3.12/threading.py"), frame("call", "/venv/rclpy/client.py"), frame("divide"))


def correct_result(service: str, a: int, b: int) -> int:
    """The right result; 0 for a division by zero."""
    computes = COMPUTES[service]
    assert computes is not None
    return computes(a, b) or 0


def right_answer(service: str, a: int = 6, b: int = 3) -> CallAnswer:
    return called(service, a, b, correct_result(service, a, b))


ANSWERS = tuple(right_answer(service) for service in COMPUTES)
