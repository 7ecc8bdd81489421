#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from time import sleep
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException

from example_interfaces.srv import AddTwoInts


class Delay_Node(Node):
    """
    Services:
      /slow_add (AddTwoInts): delay for 3 seconds before returning
    """

    def __init__(self):
        super().__init__("delay_node")
        cbg = ReentrantCallbackGroup()
        self.delay_srv = self.create_service(
            AddTwoInts, "slow_add", self.delay_callback, callback_group=cbg)
        self.tmr = self.create_timer(0.1, self.tmr_callback, callback_group=cbg)
        self.ticks = 0

    def delay_callback(self, response, request):
        sleep(3)
        response.sum = request.a + request.b
        return response

    def tmr_callback(self):
        self.ticks += 1
        if not self.ticks % 5:
            self.get_logger().info(f"{self.ticks} ticks")


def delay_entry(args=None):
    rclpy.init(args=args)
    node = Delay_Node()
    ex = MultiThreadedExecutor(num_threads=5)
    ex.add_node(node)
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    delay_entry()
