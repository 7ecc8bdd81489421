"""Takes a topic's messages in batches: at 10 kHz that is a hundred wake-ups a second, not ten thousand."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.context import Context
    from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
    from rclpy.subscription import Subscription

DEPTH = 10_000
"""Queue depth in messages: one second of a 10 kHz topic."""

MAX_BYTES = 30_000_000
"""Bound on the memory of one batch and of a queue of large messages, in bytes."""

MAX_BATCH = 5_000

Received = tuple[Any, dict[str, Any]]
"""A message (bytes if raw) and its rmw message info: timestamps in ns and sequence numbers."""


def wait_for_any(
    context: Context, subscriptions: Iterable[Subscription], limit_s: float, wake: _rclpy.GuardCondition | None = None
) -> None:
    """Wait until one of the subscriptions has a message or `wake` is triggered, for at most `limit_s` seconds."""
    from rclpy.impl.implementation_singleton import rclpy_implementation

    handles = [subscription.handle for subscription in subscriptions]
    # A new wait set each time, so that it holds no handle after the wait.
    wait_set = rclpy_implementation.WaitSet(len(handles), int(wake is not None), 0, 0, 0, 0, context.handle)
    wait_set.clear_entities()
    for handle in handles:
        wait_set.add_subscription(handle)
    if wake is not None:
        wait_set.add_guard_condition(wake)
    wait_set.wait(int(limit_s * 1e9))


def take_all(subscription: Subscription, *, raw: bool) -> tuple[list[Received], int]:
    """Take the queued messages (at most MAX_BYTES of them). Return them and the size of the first, in bytes."""
    taken: list[Received] = []
    take, message_type = subscription.handle.take_message, subscription.msg_type
    with subscription.handle:
        if (first := take(message_type, True)) is None:
            return [], 0
        size = len(first[0])
        taken.append(first if raw else _deserialized(first, message_type))
        limit = min(MAX_BATCH, max(1, MAX_BYTES // size))
        while len(taken) < limit and (received := take(message_type, raw)) is not None:
            taken.append(received)
    return taken, size


def _deserialized(received: Received, message_type: Any) -> Received:
    from rclpy.serialization import deserialize_message  # late: usage errors of `ros2` do not need rclpy

    return deserialize_message(received[0], message_type), received[1]


def never_called(_message: Any) -> None:
    """The callback of a subscription whose messages are taken by `take_all`, and by no executor."""
    raise AssertionError("no executor takes these messages")
