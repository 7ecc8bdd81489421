#!/usr/bin/env python3
import time
import rclpy
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from rclpy.callback_groups import ReentrantCallbackGroup
from example_interfaces.srv import AddTwoInts


class ConcurrentService(Node):

    def __init__(self):
        super().__init__('concurrent_service')
        group = ReentrantCallbackGroup()
        self.create_service(AddTwoInts, 'slow_add', self.on_add, callback_group=group)
        self.create_timer(0.1, self.on_timer, callback_group=group)
        self.ticks = 0

    def on_timer(self):
        self.ticks += 1
        if self.ticks % 5 == 0:
            self.get_logger().info(f'tick {self.ticks}')

    def on_add(self, request, response):
        for step in range(30):
            if not rclpy.ok():
                return response
            time.sleep(0.1)
            if step % 3 == 2:
                self.get_logger().info(f'step {step + 1} of 30')
        response.sum = request.a + request.b
        return response


def main():
    rclpy.init()
    node = ConcurrentService()
    ex = MultiThreadedExecutor(8)
    ex.add_node(node)
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    ex.shutdown()
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
