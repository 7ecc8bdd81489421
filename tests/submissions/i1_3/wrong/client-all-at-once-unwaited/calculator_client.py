import sys
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node

OPERATIONS = ["add", "subtract", "multiply", "divide"]


class Client(Node):
    def __init__(self):
        super().__init__("client")
        self.answers = {}
        for name in OPERATIONS:
            c = self.create_client(AddTwoInts, name)
            c.call_async(AddTwoInts.Request(a=20, b=4)).add_done_callback(
                lambda future, name=name: self.got(name, future.result().sum)
            )

    def got(self, name, value):
        self.answers[name] = value
        self.get_logger().info(f"{name} -> {value}")


rclpy.init()
client = Client()
until = time.time() + 2.0
while len(client.answers) < 4 and time.time() < until:
    rclpy.spin_once(client, timeout_sec=0.1)
complete = len(client.answers) == 4
client.destroy_node()
rclpy.shutdown()
sys.exit(0 if complete else 1)
