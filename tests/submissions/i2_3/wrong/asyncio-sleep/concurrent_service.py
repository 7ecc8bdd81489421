import asyncio

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.group = ReentrantCallbackGroup()
        self.ticks = 0
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=self.group)
        self.timer = self.create_timer(0.1, self.tick, callback_group=self.group)

    async def slow_add(self, request, response):
        self.get_logger().info('working...')
        await asyncio.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def tick(self):
        self.ticks += 1
        self.get_logger().info(f'tick {self.ticks}')


def main():
    rclpy.init()
    node = ConcurrentService()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
