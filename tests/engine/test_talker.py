"""Our publisher on the learner's domain: it feeds the node, and can leave and come back."""

from __future__ import annotations

import time

from tests.engine.helpers import FILE, Scene, node
from tutor.judge.bench import Run
from tutor.judge.peers import Offer, Publisher
from tutor.ros_model import QoS

CHATTER, STRING = "/chatter", "std_msgs/msg/String"
STARTUP_S = 20.0
LISTENS = """
node.create_subscription(String, "chatter", lambda message: node.get_logger().info(message.data), 10)
node.create_timer(0.02, lambda: print(node.count_publishers("chatter"), flush=True))
"""


async def wait_for_match(run: Run, talker: Publisher) -> None:
    assert await run.until(lambda: talker.subscribers == 1, STARTUP_S), run.trace()


async def wait_for_logs(run: Run, *texts: str) -> None:
    assert await run.until(lambda: [log.text for log in run.logs] == list(texts), STARTUP_S), run.logs


def publisher_counts(run: Run) -> list[str]:
    """Return the numbers of publishers that the node saw, one entry per change."""
    seen = [line.text for line in run.output if line.stream == "stdout"]
    return [text for before, text in zip(["", *seen], seen, strict=False) if text != before]


async def test_a_node_receives_messages_in_order_and_at_known_times_until_the_publisher_leaves_and_from_the_next(
    scene: Scene,
) -> None:
    async with scene.bench(node(LISTENS)).start(FILE) as run:
        async with run.publisher(CHATTER, STRING) as talker:
            assert talker.subscribers == 0
            await wait_for_match(run, talker)
            before = time.time()
            first = talker.publish({"data": "one"})
            second = talker.publish({"data": "two"})
            await wait_for_logs(run, "one", "two")
            assert before <= first.source_time <= second.source_time <= run.logs[-1].stamp + 0.01
            assert (first.topic, first.message) == (CHATTER, {"data": "one"})
            assert await run.until(lambda: publisher_counts(run)[-1:] == ["1"], STARTUP_S)
        assert await run.until(lambda: publisher_counts(run)[-1] == "0", STARTUP_S), publisher_counts(run)
        async with run.publisher(CHATTER, STRING) as talker:
            await wait_for_match(run, talker)
            talker.publish({"data": "after"})
            await wait_for_logs(run, "one", "two", "after")


async def test_our_publisher_is_not_in_the_graph_and_matches_only_compatible_subscriptions(scene: Scene) -> None:
    durable = """
from rclpy.qos import QoSProfile, DurabilityPolicy, ReliabilityPolicy
node.create_subscription(String, "chatter", print, QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
node.create_subscription(String, "chatter", print, QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
"""
    async with scene.bench(node(durable)).start(FILE) as run, run.publisher(CHATTER, STRING) as talker:
        await wait_for_match(run, talker)
        assert await run.until(lambda: len(run.graph.subscriptions) == 2, STARTUP_S)
        assert talker.subscribers == 1
        assert run.graph.publishers == ()
        # DDS announces a node's endpoints before the node.
        assert await run.until(lambda: bool(run.graph.nodes), STARTUP_S)
        assert run.graph.nodes == ("/learner",)
        assert talker.endpoint.qos == QoS("reliable", "volatile")


async def test_every_subscription_that_was_ever_matched_is_counted(scene: Scene) -> None:
    renews = """
def renew(message):
    node.get_logger().info(message.data)
    node.destroy_subscription(node.create_subscription(String, "chatter", print, 10))
node.create_subscription(String, "chatter", renew, 10)
"""
    async with scene.bench(node(renews)).start(FILE) as run, run.publisher(CHATTER, STRING) as talker:
        assert talker.matches == 0
        await wait_for_match(run, talker)
        assert talker.matches == talker.matches == 1
        for count in (2, 3, 4):
            talker.publish({"data": str(count)})
            assert await run.until(lambda count=count: talker.matches == count, STARTUP_S), talker.matches  # type: ignore[misc]
        assert await run.until(lambda: talker.subscribers == 1, STARTUP_S)


async def test_publishers_that_are_offered_are_there_before_the_node_and_keep_what_they_published_for_it(
    scene: Scene,
) -> None:
    late = """
from rclpy.qos import QoSProfile, DurabilityPolicy
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
node.create_subscription(String, "gate", lambda message: node.get_logger().info(message.data), latched)
node.create_subscription(String, "sound", lambda message: node.get_logger().info(message.data), 10)
"""
    kept = Offer("/gate", STRING, QoS(durability="transient_local"), 1, ({"data": "shut"}, {"data": "open"}))
    lossy = Offer("/sound", STRING, QoS(reliability="best_effort"), 1)
    async with scene.bench(node(late)).start(FILE, offers=[kept, lossy]) as run:
        await wait_for_match(run, run.offered("/gate"))
        assert await run.until(lambda: any(log.text == "open" for log in run.logs), STARTUP_S), run.trace()
        assert await run.until(lambda: len(run.graph.subscriptions) == 2, STARTUP_S)
        assert run.offered("/sound").subscribers == 0
        assert run.offered("/sound").endpoint.qos == QoS(reliability="best_effort")
        assert not any(log.text == "shut" for log in run.logs)
        assert run.graph.publishers == ()
        assert await run.until(lambda: any("incompatible QoS" in log.text for log in run.logs), STARTUP_S)
