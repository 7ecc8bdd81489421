"""Takes a topic's messages in batches: at 10 kHz that is a hundred wake-ups a second, not ten thousand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.subscription import Subscription

DEPTH = 10_000
"""Queue depth in messages: one second of a 10 kHz topic."""

MAX_BYTES = 30_000_000
"""Bound on the memory of one batch and of a queue of large messages, in bytes."""

MAX_BATCH = 5_000

Received = tuple[Any, dict[str, Any]]
"""A message (bytes if raw) and its rmw message info: timestamps in ns and sequence numbers."""


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
