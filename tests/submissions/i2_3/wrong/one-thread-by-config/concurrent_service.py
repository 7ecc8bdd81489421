#!/usr/bin/env python3
"""
Concurrent Service Node (Raspberry Pi 5 edition)

- /slow_add takes 3 seconds per request
- 10 Hz timer in a reentrant callback group
"""

import os
import time
from collections import deque

import rclpy
from rclpy.node import Node
from rclpy.callback_groups import ReentrantCallbackGroup, MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException

from example_interfaces.srv import AddTwoInts

# ---------------------------------------------------------------------------
# Configuration (normally comes from config_loader)
# ---------------------------------------------------------------------------
NODE_CONFIG = {
    "name": "concurrent_service",
    "service": "slow_add",
    "processing_time": 3.0,
    "timer_hz": 10.0,
}
DIAG_CONFIG = {
    "log_every": 10,
    "history": 50,
}


class ConcurrentServiceNode(Node):
    """Service node with concurrent timer."""

    def __init__(self):
        super().__init__(NODE_CONFIG["name"])

        self.processing_time = NODE_CONFIG["processing_time"]
        self.log_every = DIAG_CONFIG.get("log_every", 10)

        # Statistics
        self.tick_count = 0
        self.durations = deque(maxlen=DIAG_CONFIG.get("history", 50))

        self._setup_callback_groups()
        self._setup_interfaces()

    def _setup_callback_groups(self):
        """Separate groups so that the service does not block the timer."""
        self.service_group = MutuallyExclusiveCallbackGroup()
        self.timer_group = ReentrantCallbackGroup()

    def _setup_interfaces(self):
        self.service = self.create_service(
            AddTwoInts,
            NODE_CONFIG["service"],
            self.handle_slow_add,
            callback_group=self.service_group
        )
        self.tick_timer = self.create_timer(
            1.0 / NODE_CONFIG["timer_hz"],
            self.on_tick,
            callback_group=self.timer_group
        )

    def handle_slow_add(self, request, response):
        """Simulate processing, then answer."""
        started = time.time()
        time.sleep(self.processing_time)
        response.sum = request.a + request.b
        self.durations.append(time.time() - started)
        avg = sum(self.durations) / len(self.durations)
        self.get_logger().info(f"{request.a} + {request.b} = {response.sum} (avg {avg:.2f}s)")
        return response

    def on_tick(self):
        """10 Hz."""
        self.tick_count += 1
        if self.tick_count % self.log_every == 0:
            self.get_logger().info(f"Timer tick: {self.tick_count}")


def main(args=None):
    """Main function to initialize and run the node."""
    rclpy.init(args=args)

    # Set Raspberry Pi environment variable
    os.environ['RASPBERRY_PI'] = '1'

    node = ConcurrentServiceNode()

    # Use multiple threads
    thread_count = DIAG_CONFIG.get("threads", 1)
    executor = MultiThreadedExecutor(num_threads=thread_count)
    executor.add_node(node)

    print("=================================================")
    print("Concurrent Service Node")
    print("=================================================")

    try:
        node.get_logger().info("Node running.")
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        node.get_logger().info("Stopped by user.")
    except Exception as e:
        node.get_logger().error(f"Error: {str(e)}")
    finally:
        # Clean up
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
