"""Numbers as the Live page shows them."""

from __future__ import annotations

import pytest

from tutor.live.updates import TopicUpdate
from tutor.ros_model import QoS, Timing
from tutor.tui.live import formatting


@pytest.mark.parametrize(
    ("durations", "shown"),
    [
        ([0.05] * 3, "4 messages · 20.0 Hz · jitter 0 ms (50 to 50 ms)"),
        ([0.001] * 20, "21 messages · 1,000 Hz · jitter 0 ms (1 to 1 ms)"),
        ([5e-6] * 29, "30 messages · a burst"),
        ([0.0], "2 messages · a burst"),
        ([5e-6] * 29 + [2.0], "31 messages · 15.0 Hz · jitter 359 ms (0.005 ms to 2 s)"),
    ],
)
def test_messages_that_came_at_once_have_no_rate(durations: list[float], shown: str) -> None:
    update = TopicUpdate("/t", "std_msgs/msg/Empty", QoS(), len(durations) + 1, 0, Timing.of(durations), 0.1)
    assert formatting.numbers(update) == shown
