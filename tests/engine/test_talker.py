"""A publisher of ours on the learner's domain: it feeds the node, and it can go away and come back."""

from __future__ import annotations

import time

from tests.engine.made import FILE, Scene, node
from tutor.judge.bench import Publisher, Run
from tutor.ros_model import QoS

CHATTER, STRING = "/chatter", "std_msgs/msg/String"
UP_S = 20.0
HEARS = """
node.create_subscription(String, "chatter", lambda message: node.get_logger().info(message.data), 10)
node.create_timer(0.02, lambda: print(node.count_publishers("chatter"), flush=True))
"""


async def matched(run: Run, talker: Publisher) -> None:
    assert await run.until(lambda: talker.subscribers == 1, UP_S), run.trace()


async def heard(run: Run, *texts: str) -> None:
    assert await run.until(lambda: [log.text for log in run.logs] == list(texts), UP_S), run.logs


def publishers_seen(run: Run) -> list[str]:
    """How many publishers the node saw, with each change."""
    seen = [line.text for line in run.output if line.stream == "stdout"]
    return [text for before, text in zip(["", *seen], seen, strict=False) if text != before]


async def test_a_node_hears_what_is_published_in_order_and_at_known_times(scene: Scene) -> None:
    async with scene.bench(node(HEARS)).start(FILE) as run, run.publisher(CHATTER, STRING) as talker:
        assert talker.subscribers == 0
        await matched(run, talker)
        before = time.time()
        first = talker.publish({"data": "one"})
        second = talker.publish({"data": "two"})
        await heard(run, "one", "two")
    assert before <= first.source_time <= second.source_time <= run.logs[-1].stamp + 0.01
    assert (first.topic, first.message) == (CHATTER, {"data": "one"})


async def test_it_goes_away_and_another_takes_its_place(scene: Scene) -> None:
    async with scene.bench(node(HEARS)).start(FILE) as run:
        async with run.publisher(CHATTER, STRING) as talker:
            await matched(run, talker)
            talker.publish({"data": "before"})
            await heard(run, "before")
            assert await run.until(lambda: publishers_seen(run)[-1:] == ["1"], UP_S)
        assert await run.until(lambda: publishers_seen(run)[-1] == "0", UP_S), publishers_seen(run)
        async with run.publisher(CHATTER, STRING) as talker:
            await matched(run, talker)
            talker.publish({"data": "after"})
            await heard(run, "before", "after")


async def test_it_is_no_part_of_the_learners_graph_and_matches_a_talkers_listeners_only(scene: Scene) -> None:
    durable = """
from rclpy.qos import QoSProfile, DurabilityPolicy, ReliabilityPolicy
node.create_subscription(String, "chatter", print, QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
node.create_subscription(String, "chatter", print, QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
"""
    async with scene.bench(node(durable)).start(FILE) as run, run.publisher(CHATTER, STRING) as talker:
        await matched(run, talker)
        assert await run.until(lambda: len(run.graph.subscriptions) == 2, UP_S)
        assert talker.subscribers == 1
        assert run.graph.publishers == ()
        assert await run.until(lambda: bool(run.graph.nodes), UP_S)  # DDS tells of a node's endpoints before it
        assert run.graph.nodes == ("/learner",)
        assert talker.endpoint.qos == QoS("reliable", "volatile")
