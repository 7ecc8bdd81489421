"""The messages of a topic, in batches, for the verbs that show or measure them until Ctrl+C."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from tutor.bundled_ros.ros2.calling import make_executor
from tutor.bundled_ros.ros2.domain import Domain
from tutor.ros.batches import DEPTH, MAX_BYTES, Received, never_called, take_all, wait_for_any

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile
    from rclpy.subscription import Subscription

LARGE_MESSAGE_BYTES = 10_000
"""Messages larger than this, in bytes, get a shorter queue, so that it holds at most MAX_BYTES."""

_WAIT_S = 0.05  # Ctrl+C takes effect between two waits
_EVENTS_PERIOD_S = 0.1


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
    """Subscribe and yield messages in batches, forever; a batch, perhaps empty, comes at least ten times a second.

    Messages accumulate for `gather_s` seconds between two batches. `on_lost` is called when messages were lost.
    """
    from rclpy.event_handler import SubscriptionEventCallbacks

    node = domain.node
    group = _events_only_group()

    def subscribe() -> Subscription:
        events = SubscriptionEventCallbacks(message_lost=on_lost)
        return node.create_subscription(
            message_type, topic, never_called, qos, callback_group=group, event_callbacks=events, raw=raw
        )

    subscription = subscribe()
    # The executor handles lost-message and incompatible-QoS events, and /clock with simulated time.
    executor = make_executor(node)
    next_events_at = 0.0
    while True:
        wait_for_any(node.context, [subscription], _WAIT_S)
        taken, size = take_all(subscription, raw=raw)
        if qos.depth == DEPTH and size > LARGE_MESSAGE_BYTES:
            qos.depth = max(1, MAX_BYTES // size)
            node.destroy_subscription(subscription)
            subscription = subscribe()
        yield taken
        if (now := time.monotonic()) >= next_events_at:
            next_events_at = now + _EVENTS_PERIOD_S
            executor.spin_once(timeout_sec=0)
        time.sleep(gather_s)


def _events_only_group() -> Any:
    from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
    from rclpy.subscription import Subscription

    class OnlyEvents(MutuallyExclusiveCallbackGroup):
        """Keeps the executor from taking the messages."""

        def can_execute(self, entity: Any) -> bool:
            return not isinstance(entity, Subscription) and bool(super().can_execute(entity))  # type: ignore[no-untyped-call]

    return OnlyEvents()  # type: ignore[no-untyped-call]
