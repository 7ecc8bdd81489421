#!/usr/bin/env python
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


def own_group(group=MutuallyExclusiveCallbackGroup()):
    """Options that give an entity a callback group of its own."""
    return {'callback_group': group}


class MissionNode(Node):

    def __init__(self, node_name='mission'):
        super().__init__(node_name)
        self.mission_started = False

    def sleep(self, seconds):
        time.sleep(seconds)

    def status(self, text):
        self.get_logger().info(text)


class ConcurrentMission(MissionNode):

    def __init__(self, node_name='concurrent_service'):
        super().__init__(node_name)

        self.ticks = 0
        self.status_timer = self.create_timer(
            0.1,
            self.status_cb,
            **own_group()
        )

        self.slow_add_service = self.create_service(
            AddTwoInts,
            'slow_add',
            self.slow_add_cb,
            **own_group()
        )

    def status_cb(self):
        self.ticks += 1
        self.status('status tick {}'.format(self.ticks))

    def slow_add_cb(self, request, response):
        self.status('slow_add: {} + {}'.format(request.a, request.b))
        self.sleep(3.0)
        response.sum = request.a + request.b
        self.status('slow_add finished')
        return response


def main():
    rclpy.init()
    mission = ConcurrentMission()
    mt_executor = MultiThreadedExecutor(num_threads=4)
    mt_executor.add_node(mission)
    try:
        mt_executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    mission.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
