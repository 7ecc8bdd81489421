"""A lamp asks a switch, in a callback. Each has its own thread."""

import threading

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger


class Switch(Node):
    """Replies at once."""

    def __init__(self):
        super().__init__("switch")
        self.ended = threading.Event()
        self.replied = threading.Event()
        self.create_service(Trigger, "position", self.reply)

    def reply(self, request, response):
        self.replied.set()
        response.message = "on"
        return response

    def work(self):
        executor = SingleThreadedExecutor()
        executor.add_node(self)
        while not self.ended.is_set():
            executor.spin_once(timeout_sec=0.1)


class Lamp(Node):
    """Asks, and waits for two seconds."""

    def __init__(self):
        super().__init__("lamp")
        self.got = []
        self.client = self.create_client(Trigger, "position")
        self.timer = self.create_timer(0.1, self.ask)

    def ask(self):
        self.timer.cancel()  # it asks only once
        self.client.wait_for_service()
        reply = self.client.call(Trigger.Request(), timeout_sec=2.0)
        self.got.append(reply.message if reply else "nothing")


rclpy.init()
switch, lamp = Switch(), Lamp()
executor = SingleThreadedExecutor()
executor.add_node(lamp)
thread = threading.Thread(target=switch.work)
thread.start()
while not lamp.got:
    executor.spin_once(timeout_sec=0.1)
replied = "replied" if switch.replied.wait(30.0) else "was not asked"
print(f"the switch {replied}; the lamp got {lamp.got[0]}", flush=True)
switch.ended.set()
thread.join()
rclpy.try_shutdown()
