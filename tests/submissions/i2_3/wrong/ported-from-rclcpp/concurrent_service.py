#!/usr/bin/env python3
# Python version of concurrent_service.cpp
import time

import rclpy
import rclpy.callback_groups
import rclpy.executors
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class ConcurrentService(Node):
    """
    Subclass of ROS2 Node class. Slow service and fast timer.
    """

    def __init__(self):
        """
        Class constructor to set up the node
        """
        # initiate the Node class's constructor and give it a name
        super().__init__('concurrent_service')
        # create callback groups to allow for parallel execution
        self.service_group_ = self.create_callback_group(
            rclpy.callback_groups.ReentrantCallbackGroup)
        self.timer_group_ = self.create_callback_group(
            rclpy.callback_groups.ReentrantCallbackGroup)
        # create service
        self.service_ = self.create_service(AddTwoInts, 'slow_add', self.slow_add,
                                            callback_group=self.service_group_)
        # create timer, 100 ms
        self.timer_ = self.create_wall_timer(100, self.timer_callback, self.timer_group_)
        self.tick_ = 0

    def slow_add(self, request, response):
        """
        Service callback
        """
        self.get_logger().info('Incoming request: %d %d' % (request.a, request.b))
        time.sleep(3)
        response.sum = request.a + request.b
        return response

    def timer_callback(self):
        """
        Timer callback
        """
        self.tick_ += 1
        if self.tick_ % 10 == 0:
            self.get_logger().info('tick %d' % self.tick_)


def main(args=None):
    rclpy.init(args=args)
    node = ConcurrentService()
    executor = rclpy.executors.MultiThreadedExecutor(4)
    executor.add_node(node)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
