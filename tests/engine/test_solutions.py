"""What our solutions do beyond what a check requires."""

from __future__ import annotations

import asyncio

import pytest

from tests.engine.helpers import Scene
from tutor.content import load_course
from tutor.judge.submission import Submission
from tutor.workspace import solution

ADD = "example_interfaces/srv/AddTwoInts"
LEAST, MOST = -(2**63), 2**63 - 1
STARTUP_S, ANSWER_S = 60.0, 20.0


@pytest.mark.timeout(200)
async def test_the_calculator_saturates_results_outside_int64(scene: Scene) -> None:
    file = "calculator_server.py"
    files = solution(load_course().find("i1.3")).files
    bench = scene.bench_of(Submission("i1.3", files))
    async with bench.start(file) as run:
        assert await run.until(lambda: "/divide" in [each.name for each in run.graph.servers], STARTUP_S)
        for service, a, b, nearest in (
            ("/add", MOST, 1, MOST),
            ("/add", LEAST, -1, LEAST),
            ("/subtract", LEAST, MOST, LEAST),
            ("/multiply", MOST, MOST, MOST),
            ("/multiply", LEAST, 2, LEAST),
            ("/divide", LEAST, -1, MOST),
            ("/add", 1, 2, 3),
        ):
            answer = await run.call(service, ADD, {"a": a, "b": b}, limit_s=ANSWER_S)
            assert answer.response == {"sum": nearest}, (service, a, b, run.output)
        errors = [log.text for log in run.logs if log.level >= 40]
        assert await run.until(lambda: len([log for log in run.logs if log.level >= 40]) == 6, ANSWER_S), errors
        assert run.exit is None


@pytest.mark.timeout(200)
async def test_the_slow_service_saturates_results_outside_int64(scene: Scene) -> None:
    file = "concurrent_service.py"
    files = solution(load_course().find("i2.3")).files
    bench = scene.bench_of(Submission("i2.3", files))
    requests = ((MOST, 1, MOST), (LEAST, -1, LEAST), (1, 2, 3))
    async with bench.start(file) as run:
        assert await run.until(lambda: "/slow_add" in [each.name for each in run.graph.servers], STARTUP_S)
        responses = await asyncio.gather(
            *(run.call("/slow_add", ADD, {"a": a, "b": b}, limit_s=ANSWER_S) for a, b, _ in requests)
        )
        assert [each.response for each in responses] == [{"sum": nearest} for _, _, nearest in requests], run.output
        assert await run.until(lambda: len([log for log in run.logs if log.level >= 40]) == 2, ANSWER_S), run.logs
        assert run.exit is None
