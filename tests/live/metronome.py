"""Publish COUNT Float64 at a steady rate once there is a subscriber: `metronome.py RATE_HZ COUNT [DEPTH]`.

The messages are serialized in advance, so that Python can keep up with 10 kHz.
"""

from __future__ import annotations

import sys
import time

import rclpy
from rclpy.serialization import serialize_message
from std_msgs.msg import Float64

LIMIT_S = 30.0


def main() -> None:
    rate, count = float(sys.argv[1]), int(sys.argv[2])
    depth = int(sys.argv[3]) if len(sys.argv) > 3 else 1000
    rclpy.init()
    node = rclpy.create_node("metronome")
    publisher = node.create_publisher(Float64, "/ticks", depth)
    messages = [serialize_message(Float64(data=float(step % 100))) for step in range(100)]
    print("ready", flush=True)
    deadline = time.monotonic() + LIMIT_S
    while publisher.get_subscription_count() == 0 and time.monotonic() < deadline:
        time.sleep(0.01)
    begin = time.perf_counter()
    sent = 0
    while sent < count:
        due = min(count, int((time.perf_counter() - begin) * rate) + 1)
        while sent < due:
            publisher.publish(messages[sent % 100])
            sent += 1
        time.sleep(max(0.0, begin + sent / rate - time.perf_counter()))
    print(f"{sent} {time.perf_counter() - begin:.3f}", flush=True)
    time.sleep(LIMIT_S)  # until it is killed: messages not yet read are lost when their publisher leaves


if __name__ == "__main__":
    main()
