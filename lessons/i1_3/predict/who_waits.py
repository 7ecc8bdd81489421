"""A node that takes its time over a message, and over a call."""

import threading

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger


class Slow(Node):
    """Works until the other side has gone on, two seconds at most."""

    def __init__(self):
        super().__init__("slow")
        self.published = threading.Event()
        self.called = threading.Event()
        self.seen = []
        self.create_subscription(String, "news", self.hear, 10)
        self.create_service(Trigger, "status", self.answer)

    def hear(self, message):
        self.work("publisher", self.published)

    def answer(self, request, response):
        self.work("caller", self.called)
        return response

    def work(self, other, returned):
        does = "goes on" if returned.wait(timeout=2.0) else "waits"
        self.seen.append(f"the {other} {does}")
        print(f"while I work, {self.seen[-1]}", flush=True)


def send():
    publisher.publish(String(data="hello"))
    slow.published.set()  # publish() has returned
    client.call(Trigger.Request())
    slow.called.set()  # call() has returned


rclpy.init()
slow, hasty = Slow(), rclpy.create_node("hasty")
publisher = hasty.create_publisher(String, "news", 10)
client = hasty.create_client(Trigger, "status")
executor = SingleThreadedExecutor()
executor.add_node(slow)
executor.add_node(hasty)
while publisher.get_subscription_count() == 0:
    executor.spin_once(timeout_sec=0.1)
while not client.service_is_ready():
    executor.spin_once(timeout_sec=0.1)

sender = threading.Thread(target=send)
sender.start()
while sender.is_alive() or len(slow.seen) < 2:
    executor.spin_once(timeout_sec=0.1)
print("; ".join(sorted(slow.seen)), flush=True)
rclpy.try_shutdown()
