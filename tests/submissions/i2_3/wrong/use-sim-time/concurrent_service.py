#!/usr/bin/env python3
"""Pick server for the gazebo arm, boiled down to slow_add."""

import time

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter

from example_interfaces.srv import AddTwoInts

EXECUTION_TIME = 3.0
STATUS_RATE_HZ = 10.0


class SlowAddServer(Node):

    def __init__(self):
        # same overrides as the other nodes of the arm stack
        super().__init__(
            'slow_add_server',
            parameter_overrides=[
                Parameter('use_sim_time', Parameter.Type.BOOL, True),
            ],
        )
        self._cb_group = ReentrantCallbackGroup()
        self._status_seq = 0

        self.create_service(
            AddTwoInts, 'slow_add', self._execute, callback_group=self._cb_group)
        self.create_timer(
            1.0 / STATUS_RATE_HZ, self._status, callback_group=self._cb_group)
        self.get_logger().info('slow_add server up')

    def _execute(self, request, response):
        self.get_logger().info(f'Executing {request.a} + {request.b}')
        time.sleep(EXECUTION_TIME)
        response.sum = request.a + request.b
        self.get_logger().info('Done')
        return response

    def _status(self):
        self._status_seq += 1
        self.get_logger().info(f'status #{self._status_seq}')


def main():
    rclpy.init()
    node = SlowAddServer()
    # Pairs with the ReentrantCallbackGroup above
    executor = MultiThreadedExecutor(num_threads=6)
    try:
        rclpy.spin(node, executor=executor)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
