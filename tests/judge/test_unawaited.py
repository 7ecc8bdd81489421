"""Coroutines that nothing awaits: the cause, with the step, from Python's warning and the learner's source."""

from __future__ import annotations

import pytest

from tests.checks.builders import trace
from tutor.judge.causes.unawaited import diagnose_unawaited, unawaited_names
from tutor.judge.step_parsing import apply_step

WARNING = "/n.py:9: RuntimeWarning: coroutine 'Talker.tick' was never awaited"
LAMBDA = """\
class Talker(Node):
    def __init__(self):
        self.create_timer(1.0, lambda: self.tick())

    async def tick(self):
        self.publish()
"""
DECORATED = """\
def timed(limit):
    def decorate(method):
        @wraps(method)
        def wrapper(self):
            return method(self)
        return wrapper
    return decorate


class Talker(Node):
    @timed(1.0)
    async def tick(self):
        self.publish(await self.read())
"""


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (LAMBDA, "async def tick", "def tick"),
        (
            DECORATED,
            "def wrapper(self):\n            return method",
            "async def wrapper(self):\n            return await method",
        ),
    ],
)
def test_what_calls_a_coroutine_function_gets_what_it_can_call(text: str, old: str, new: str) -> None:
    found = diagnose_unawaited(trace(out=WARNING, sources={"node.py": text}))
    assert found is not None
    assert "tick is an async def" in found.text
    assert apply_step(found.hint, {"node.py": text})["node.py"] == text.replace(old, new)


@pytest.mark.parametrize(
    ("out", "text"),
    [
        ("", LAMBDA),  # Python did not warn
        (WARNING.replace("tick", "other"), LAMBDA),
        (WARNING, LAMBDA.replace("self.publish()", "await self.publish()")),
        (WARNING, f"{LAMBDA}\n    async def all(self):\n        await self.tick()\n"),
    ],
)
def test_a_coroutine_function_that_is_needed_or_not_known_is_left_alone(out: str, text: str) -> None:
    assert diagnose_unawaited(trace(out=out, sources={"node.py": text})) is None


def test_each_name_is_found_once() -> None:
    warnings = [WARNING, WARNING, "RuntimeWarning: coroutine 'f.<locals>.go' was never awaited"]
    assert unawaited_names(trace(out="\n".join(warnings))) == ["tick", "go"]
