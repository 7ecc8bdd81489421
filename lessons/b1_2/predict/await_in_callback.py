"""A lamp awaits a reply. Its client is in a group of its own."""

import threading

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger


class Switch(Node):
    """Replies once the lamp has blinked, or after two seconds."""

    def __init__(self):
        super().__init__("switch")
        self.ended = threading.Event()
        self.create_service(Trigger, "position", self.reply)

    def reply(self, request, response):
        seen = lamp.blinked.wait(timeout=2.0)
        response.message = "blinks" if seen else "stays dark"
        return response

    def work(self):
        executor = SingleThreadedExecutor()
        executor.add_node(self)
        while not self.ended.is_set():
            executor.spin_once(timeout_sec=0.1)


class Lamp(Node):
    """Blinks and asks, with one thread."""

    def __init__(self):
        super().__init__("lamp")
        self.asking, self.got = False, []
        self.blinked = threading.Event()
        own = MutuallyExclusiveCallbackGroup()
        self.client = self.create_client(
            Trigger,
            "position",
            callback_group=own,
        )
        self.timer = self.create_timer(0.1, self.ask)
        self.create_timer(0.1, self.blink)

    async def ask(self):
        self.timer.cancel()  # it asks only once
        self.client.wait_for_service()
        self.asking = True
        reply = await self.client.call_async(Trigger.Request())
        self.got.append(reply.message)

    def blink(self):
        if self.asking:
            self.blinked.set()


rclpy.init()
switch, lamp = Switch(), Lamp()
executor = SingleThreadedExecutor()
executor.add_node(lamp)
thread = threading.Thread(target=switch.work)
thread.start()
for _ in range(300):
    if lamp.got:
        break
    executor.spin_once(timeout_sec=0.1)
reply = f"the lamp {lamp.got[0]}" if lamp.got else "none"
print(f"the reply: {reply}", flush=True)
switch.ended.set()
thread.join()
rclpy.try_shutdown()
