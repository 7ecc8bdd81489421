"""Few large messages of a followed or echoed topic are held in memory at a time."""

from __future__ import annotations

import contextlib
from typing import Any

import pytest

from tests.live.private_domain import private_domain
from tests.live.test_live_process import LIMIT_S, Watcher
from tutor.live.protocol import Follow
from tutor.live.updates import TopicUpdate

BIG = """
import sys
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
node = Node("big")
publisher = node.create_publisher(String, "big", 10)
message = String(data="x" * int(sys.argv[1]))
node.create_timer(0.02, lambda: publisher.publish(message))
print("ready", flush=True)
rclpy.spin(node)
"""


def peak_memory_mb(pid: int) -> float:
    with open(f"/proc/{pid}/status") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith("VmHWM"))


def test_following_a_topic_with_big_messages_takes_little_memory(tmp_path: Any) -> None:
    (tmp_path / "big.py").write_text(BIG)
    with private_domain() as ros_world, contextlib.ExitStack() as stack:
        ros_world.run(tmp_path / "big.py", "1000000")
        watcher = Watcher(ros_world)
        stack.callback(watcher.close)
        watcher.wait_until_ready()
        before = peak_memory_mb(watcher.process.pid)
        watcher.send(Follow("/big"))
        updates = (each for each in watcher.updates(LIMIT_S) if isinstance(each, TopicUpdate))
        last = next(each for each in updates if each.count > 100)
        assert last.count > 100
        assert peak_memory_mb(watcher.process.pid) - before < 100


class FakeHandle(contextlib.nullcontext[None]):
    """The fake handle of a subscription with an endless queue of messages of one size."""

    def __init__(self, size: int) -> None:
        super().__init__()
        self._message = bytes(size)

    def take_message(self, kind: Any, raw: bool) -> tuple[bytes, dict[str, Any]]:
        assert raw
        return self._message, {}


class FakeSubscription:
    msg_type = None

    def __init__(self, size: int) -> None:
        self.handle = FakeHandle(size)


@pytest.mark.parametrize("size", [8, 100_000, 1_000_000, 100_000_000])
def test_a_batch_of_big_messages_is_small(size: int) -> None:
    from tutor.ros import batches

    messages, total = batches.take_all(FakeSubscription(size), raw=True)  # type: ignore[arg-type]
    assert total == size
    assert len(messages) == min(5000, max(1, batches.MAX_BYTES // size))
