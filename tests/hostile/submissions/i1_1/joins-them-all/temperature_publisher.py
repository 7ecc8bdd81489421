"""Goes from domain to domain, some at a time, and is in each what all the exercises ask for, but wrong."""

import itertools
import os
import sys
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node
from std_msgs.msg import Float64, String

AT_ONCE = 12


class Impostor(Node):
    def __init__(self, context):
        super().__init__("impostor", context=context)
        self.declare_parameter("publish_rate", 7.0)
        self.temperatures = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.chatter = self.create_publisher(String, "chatter", 10)
        self.heard = self.create_subscription(String, "chatter", lambda message: None, 10)
        for name in ("add", "subtract", "multiply", "divide", "slow_add"):
            self.create_service(AddTwoInts, f"/{name}", lambda request, response: response)

    def lie(self):
        self.temperatures.publish(Float64(data=-1000.0))
        self.chatter.publish(String(data="Hello World: 1000000"))
        self.get_logger().info("count 1000000, rate 1000000.0")
        rclpy.spin_once(self, timeout_sec=0, executor=self.spinner)


def join(domain):
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    node = Impostor(context)
    node.spinner = rclpy.executors.SingleThreadedExecutor(context=context)
    return node


own = int(os.environ["ROS_DOMAIN_ID"])
near = [own + step for step in range(-40, 41) if step]
joined = []
try:
    # One that is its own would only be a node of this check's.
    for domain in itertools.cycle([*near, *range(233)]):
        joined.append(join(domain))
        if len(joined) > AT_ONCE:
            first = joined.pop(0)
            first.context.shutdown()
        for node in joined:
            node.lie()
        print("in", domain, flush=True)
        time.sleep(0.02)
except KeyboardInterrupt:
    sys.exit(0)
