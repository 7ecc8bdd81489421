"""Two timers in one reentrant group. The executor has four threads."""

import threading

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class ReentrantTimers(Node):
    """Counts how many of its callbacks run at the same time."""

    def __init__(self):
        super().__init__("reentrant_timers")
        self.running, self.most, self.ended = 0, 0, 0
        self.changed = threading.Condition()
        group = ReentrantCallbackGroup()
        self.create_timer(0.1, self.work, group)
        self.create_timer(0.1, self.work, group)

    def work(self):
        """Wait for company, but not for more than three seconds."""
        with self.changed:
            self.running += 1
            self.most = max(self.most, self.running)
            self.changed.notify_all()
            self.changed.wait_for(lambda: self.most == 4, timeout=3.0)
            self.running -= 1
            self.ended += 1


rclpy.init()
node = ReentrantTimers()
executor = MultiThreadedExecutor(num_threads=4)
executor.add_node(node)
while node.ended < 3:
    executor.spin_once(timeout_sec=0.1)
print(f"callbacks at the same time: {node.most}", flush=True)
rclpy.try_shutdown()
