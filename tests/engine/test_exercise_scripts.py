"""Criteria as functions, and a form beside them, on real nodes: a turnstile that opens by a service and counts."""

from __future__ import annotations

import re

import pytest

from tests.engine.helpers import NODE, Scene, assert_failed_for
from tutor.exercise import EndsCleanly, Node, Parameter, Program, Service, Topic, check, criterion
from tutor.judge.rates import TOLERANCE
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status

PUSH = Service("/push", "std_srvs/srv/Trigger")
PASSED = Topic("/passed", "std_msgs/msg/Int32")
CAPACITY = Parameter("capacity", 5)


@criterion("count", "an Int32 on /passed at 5 Hz, 0 at first", watch=(PASSED,))
async def counts(node: Node) -> None:
    first = await node.rate(PASSED, 5.0)
    node.expect(first.data, 0, do="Start counting at 0.")


@criterion("push", "success=true, and the count goes up by one", watch=(PASSED,), after=counts)
async def push(node: Node) -> None:
    for number in (1, 2):
        answer = await node.call(PUSH)
        node.expect(answer.success, True, do="Set success in the response.")
        shown = await node.next(PASSED, after=answer)
        node.expect(shown.data, number, do="Publish what the callback has counted.")


@criterion("limit", "capacity is an integer of 5, and 0 is refused")
async def limit(node: Node) -> None:
    assert (await node.parameter(CAPACITY)).type == "integer"
    await node.rejects(CAPACITY, 0)
    await node.set(CAPACITY, 7)


CHECK = check("t1", Program("node.py"), counts, push, limit, EndsCleanly("shutdown", bonus=True))

TURNSTILE = """
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import Int32
from std_srvs.srv import Trigger

class Turnstile:
    passed = 0
    step = 1
    success = True
    period_s = 0.2
    service = "push"

    def __init__(self):
        publisher = node.create_publisher(Int32, "passed", 10)
        node.create_timer(self.period_s, lambda: publisher.publish(Int32(data=self.passed)))
        node.create_service(Trigger, self.service, self.push)
        node.declare_parameter("capacity", 5)
        node.add_on_set_parameters_callback(self.check)

    def push(self, request, response):
        self.passed += self.step
        response.success = self.success
        return response

    def check(self, parameters):
        good = all(parameter.value > 0 for parameter in parameters)
        return SetParametersResult(successful=good, reason="" if good else "at least 1")
"""


def turnstile(change: str = "pass") -> str:
    """A learner's node: the turnstile, with a change of the class before it is made."""
    return NODE.format(f"{TURNSTILE}\n{change}\nturnstile = Turnstile()")


def statuses(result: ExerciseResult) -> dict[str, Status]:
    return {each.id: each.verdict.status for each in result.criteria}


async def test_a_right_node_passes(scene: Scene) -> None:
    result = await scene.judge(*CHECK.criteria, source=turnstile())
    assert set(statuses(result).values()) == {Status.PASSED}, result
    told = re.search(r"/passed at ([\d.]+) Hz", " ".join(result.criteria[0].verdict.evidence))
    assert told is not None
    assert float(told[1]) == pytest.approx(5.0, rel=TOLERANCE)


@pytest.mark.parametrize(
    ("change", "criterion", "mistake", "words"),
    [
        ("Turnstile.passed = 3", "count", "wrong-values", "it is 3, not 0"),
        ("Turnstile.period_s = 1.0", "count", "wrong-rate", "not 5 Hz"),
        ("Turnstile.success = False", "push", "wrong-answer", "it is false, not true"),
        ("Turnstile.step = 2", "push", "wrong-values", "it is 2, not 1"),
        ("Turnstile.service = 'shove'", "push", "wrong-service-name", "/shove"),
        ("Turnstile.push = lambda self, request, response: time.sleep(100)", "push", "blocked-executor", "no answer"),
        ("Turnstile.check = lambda self, given: SetParametersResult(successful=True)", "limit", "no-validation", "0"),
    ],
)
async def test_a_wrong_node_fails_what_it_breaks(
    scene: Scene, change: str, criterion: str, mistake: str, words: str
) -> None:
    result = await scene.judge(*CHECK.criteria, source=turnstile(change), only=frozenset({criterion}))
    assert_failed_for(result, mistake, words)


async def test_a_topic_that_is_not_watched_is_the_authors_mistake(scene: Scene) -> None:
    @criterion("next", "a message")
    async def unwatched(node: Node) -> None:
        await node.first(PASSED)

    result = await scene.judge(*check("t1", Program("node.py"), unwatched).criteria, source=turnstile())
    assert result.criteria[0].verdict.status is Status.ERROR
    assert "add the topic to its `watch`" in result.criteria[0].verdict.cause
