#!/usr/bin/env python3

import argparse
import sys
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.qos import QoSProfile, HistoryPolicy
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String


class VirtualAdder:

    def __init__(self, id, node):
        self.id = id
        self.node = node
        self.logPublisher = self.node.create_publisher(String, f"{self.id}/log", qos_profile=QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=10))
        node.create_service(AddTwoInts, "/slow_add", self.setup, callback_group=MutuallyExclusiveCallbackGroup())
        self.counter = 0

    def calculate(self, one, two):
        time.sleep(3.0)
        return one + two

    def tick_callback(self):
        self.counter += 1
        self.node.get_logger().info(f"{self.id} tick {self.counter}")

    def publish(self):
        self.node.create_timer(0.1, self.tick_callback, callback_group=ReentrantCallbackGroup())

    def setup(self, request, response):
        self.logPublisher.publish(String(data=f"Adding {request.a} and {request.b}."))
        return AddTwoInts.Response(sum=self.calculate(request.a, request.b))


def main():
    rclpy.init(args=sys.argv)
    node = rclpy.create_node('virtual_adder')

    parser = argparse.ArgumentParser(description='Starts the slow adding service.')
    parser.add_argument('id', type=str, help='Name of the drone.')
    args = parser.parse_args()

    adder = VirtualAdder(args.id, node)

    adder.publish()

    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
