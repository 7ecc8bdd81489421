"""Two callbacks call a service at once. The lamp has two threads."""

import threading

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import (
    MultiThreadedExecutor,
    SingleThreadedExecutor,
)
from rclpy.node import Node
from std_srvs.srv import Trigger


class Switch(Node):
    """Replies at once."""

    def __init__(self):
        super().__init__("switch")
        self.ended = threading.Event()
        self.create_service(Trigger, "position", self.reply)

    def reply(self, request, response):
        response.message = "on"
        return response

    def work(self):
        executor = SingleThreadedExecutor()
        executor.add_node(self)
        while not self.ended.is_set():
            executor.spin_once(timeout_sec=0.1)


class Lamp(Node):
    """One callback waits for two seconds, the other for a minute."""

    def __init__(self):
        super().__init__("lamp")
        self.got, self.both_are_here = {}, threading.Barrier(2)
        self.client = self.create_client(Trigger, "position")
        left = MutuallyExclusiveCallbackGroup()
        right = MutuallyExclusiveCallbackGroup()
        self.first = self.create_timer(0.1, self.hasty, left)
        self.second = self.create_timer(0.1, self.patient, right)

    def hasty(self):
        self.first.cancel()  # it asks only once
        self.ask("hasty", 2.0)

    def patient(self):
        self.second.cancel()
        self.ask("patient", 60.0)

    def ask(self, name, limit):
        self.both_are_here.wait()
        reply = self.client.call(Trigger.Request(), timeout_sec=limit)
        self.got[name] = reply.message if reply else "nothing"


rclpy.init()
switch, lamp = Switch(), Lamp()
executor = MultiThreadedExecutor(2)
executor.add_node(lamp)
thread = threading.Thread(target=switch.work)
thread.start()
lamp.client.wait_for_service()
while len(lamp.got) < 2:
    executor.spin_once(timeout_sec=0.1)
hasty, patient = lamp.got["hasty"], lamp.got["patient"]
print(f"hasty got {hasty}, patient got {patient}", flush=True)
switch.ended.set()
thread.join()
rclpy.try_shutdown()
