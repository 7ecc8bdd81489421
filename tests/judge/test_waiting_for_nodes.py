"""How long to wait for a message of a node that is up, depending on its publishers."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tutor.judge.trace import Sample
from tutor.judge.waiting_for_nodes import MESSAGE_GAP_S, OTHER_NAME_S, OTHER_TYPE_S, SETTLE_S, wait_for_message
from tutor.ros_model import Graph, TopicEndpoint

TOPIC, TYPE = "/sensor/temperature", "std_msgs/msg/Float64"


class FakeRun:
    """A run of a node that is up from the start, with a clock that advances only during `until`."""

    def __init__(self, *publishers: tuple[float, str, str], message_at: float = 1e9, cpu_wait_s: float = 0.0) -> None:
        self._publishers, self._message_at, self._cpu_wait_s, self._now = publishers, message_at, cpu_wait_s, 0.0

    def now(self) -> float:
        return self._now

    def node_cpu_wait_s(self) -> float:
        return min(self._now, self._cpu_wait_s)

    @property
    def graph(self) -> Graph:
        visible = [TopicEndpoint(topic, kind, "/node") for at, topic, kind in self._publishers if at <= self._now]
        return Graph(nodes=("/node",), publishers=tuple(visible))

    def samples_on(self, topic: str) -> list[Sample]:
        return [Sample(topic, {"data": 1.0}, self._now, self._now)] if self._now >= self._message_at else []

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        ends = self._now + limit_s + self._cpu_wait_s
        while not seen() and self._now < ends:
            self._now += 0.125
        return seen()


@pytest.mark.parametrize(
    ("publishers", "gives_up_after_s"),
    [
        ([], SETTLE_S),
        ([(0.0, TOPIC, TYPE)], MESSAGE_GAP_S),
        ([(0.0, "/status", "std_msgs/msg/String")], SETTLE_S),
        ([(0.0, TOPIC, "std_msgs/msg/String")], OTHER_TYPE_S),
        ([(0.0, "/temperature", TYPE)], OTHER_NAME_S),
        ([(2.0, "/temperature", TYPE)], 2.0 + OTHER_NAME_S),
        ([(4.0, "/temperature", TYPE)], SETTLE_S),
        ([(0.0, "/temperature", TYPE), (2.0, TOPIC, TYPE)], 2.0 + MESSAGE_GAP_S),
        ([(3.0, "/temperature", TYPE), (3.25, TOPIC, TYPE)], 3.25 + MESSAGE_GAP_S),
        ([(3.0, TOPIC, "std_msgs/msg/String"), (3.25, TOPIC, TYPE)], 3.25 + MESSAGE_GAP_S),
    ],
)
async def test_the_publishers_determine_how_long_to_wait(
    publishers: list[tuple[float, str, str]], gives_up_after_s: float
) -> None:
    run = FakeRun(*publishers)
    assert not await wait_for_message(run, TOPIC, TYPE)  # type: ignore[arg-type]
    assert run.now() == pytest.approx(gives_up_after_s, abs=0.2)


async def test_a_node_that_creates_the_right_publisher_late_is_waited_for() -> None:
    run = FakeRun((0.0, "/temperature", TYPE), (2.0, TOPIC, TYPE), message_at=9.0)
    assert await wait_for_message(run, TOPIC, TYPE)  # type: ignore[arg-type]


async def test_cpu_wait_of_the_node_does_not_count() -> None:
    run = FakeRun((0.0, "/temperature", TYPE), (4.0, TOPIC, TYPE), message_at=4.5, cpu_wait_s=2.0)
    assert await wait_for_message(run, TOPIC, TYPE)  # type: ignore[arg-type]


async def test_a_message_is_no_longer_waited_for_once_it_cannot_come() -> None:
    run = FakeRun((0.0, TOPIC, TYPE), message_at=9.0)
    assert not await wait_for_message(run, TOPIC, TYPE, given_up=lambda: run.now() >= 3.0)  # type: ignore[arg-type]
    assert run.now() == pytest.approx(3.0, abs=0.2)
