"""One callback waits for another one of the same node."""

import threading

import rclpy
from rclpy.node import Node


class Waiting(Node):
    """One callback asks, and waits for two seconds. One answers."""

    def __init__(self):
        super().__init__("waiting")
        self.order = []
        self.answer_came = threading.Event()
        self.asking = self.create_timer(0.1, self.ask)
        self.answering = self.create_timer(0.2, self.answer)

    def ask(self):
        self.asking.cancel()  # it asks only once
        self.order.append("asked")
        if not self.answer_came.wait(timeout=2.0):
            self.order.append("gave up")

    def answer(self):
        self.answering.cancel()
        self.order.append("answered")
        self.answer_came.set()


rclpy.init()
node = Waiting()
for _ in range(10):
    rclpy.spin_once(node, timeout_sec=0.1)
print(f"order: {', '.join(node.order)}", flush=True)
rclpy.try_shutdown()
