"""Takes the messages of a topic in batches: at 10 kHz, a hundred wake-ups a second, not ten thousand."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from tutor.bundled_ros.ros2.domain import Domain

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile
    from rclpy.subscription import Subscription

DEPTH = 10_000
"""Messages that may wait until they are taken: a second of a 10 kHz topic."""

BIG = 10_000
MOST_BYTES = 30_000_000
"""Of messages with more than `BIG` bytes, no more than `MOST_BYTES` may wait, or are given at once."""

_WAIT_NS = 50_000_000  # Ctrl+C takes effect between two waits
_EVENTS_EVERY_S = 0.1
_MOST_AT_ONCE = 5_000

Received = tuple[Any, dict[str, Any]]
"""A message (bytes, where it is raw) and rmw's facts about it: timestamps in ns, numbers."""


def receive(
    domain: Domain,
    topic: str,
    message_type: Any,
    qos: QoSProfile,
    *,
    raw: bool,
    gather_s: float,
    on_lost: Callable[[Any], None] | None = None,
) -> Iterator[list[Received]]:
    """Subscribe, and give what has arrived, batch by batch, forever; an empty batch at least ten times a second.

    Between two batches, messages gather for `gather_s` seconds. `on_lost` is called for messages that never came.
    """
    import rclpy
    from rclpy.event_handler import SubscriptionEventCallbacks
    from rclpy.impl.implementation_singleton import rclpy_implementation as implementation
    from rclpy.serialization import deserialize_message

    node = domain.node
    group = _only_events()

    def subscribe() -> Subscription:
        events = SubscriptionEventCallbacks(message_lost=on_lost)
        return node.create_subscription(
            message_type, topic, _taken_here, qos, callback_group=group, event_callbacks=events, raw=raw
        )

    subscription = subscribe()
    # Tells of lost messages and of QoS that does not fit, and follows a simulation's clock.
    executor = rclpy.executors.SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    waiting = implementation.WaitSet(1, 0, 0, 0, 0, 0, node.context.handle)
    events_at = 0.0
    while True:
        waiting.clear_entities()
        waiting.add_subscription(subscription.handle)
        waiting.wait(_WAIT_NS)
        found, size = _all_of(subscription, raw, deserialize_message)
        if qos.depth == DEPTH and size > BIG:
            qos.depth = max(1, MOST_BYTES // size)
            node.destroy_subscription(subscription)
            subscription = subscribe()
        yield found
        if (now := time.monotonic()) >= events_at:
            events_at = now + _EVENTS_EVERY_S
            executor.spin_once(timeout_sec=0)
        time.sleep(gather_s)


def _all_of(
    subscription: Subscription, raw: bool, deserialize: Callable[[bytes, Any], Any]
) -> tuple[list[Received], int]:
    """What waits, or some of it where it is big; and the size of the first message, in bytes."""
    found: list[Received] = []
    take, message_type = subscription.handle.take_message, subscription.msg_type
    with subscription.handle:
        if (first := take(message_type, True)) is None:
            return [], 0
        size = len(first[0])
        found.append(first if raw else (deserialize(first[0], message_type), first[1]))
        most = min(_MOST_AT_ONCE, max(1, MOST_BYTES // size))
        while len(found) < most and (one := take(message_type, raw)) is not None:
            found.append(one)
    return found, size


def _only_events() -> Any:
    from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
    from rclpy.subscription import Subscription

    class OnlyEvents(MutuallyExclusiveCallbackGroup):
        """Keeps the executor from the messages."""

        def can_execute(self, entity: Any) -> bool:
            return not isinstance(entity, Subscription) and bool(super().can_execute(entity))  # type: ignore[no-untyped-call]

    return OnlyEvents()  # type: ignore[no-untyped-call]


def _taken_here(_message: Any) -> None:
    raise AssertionError("the executor takes no messages")
