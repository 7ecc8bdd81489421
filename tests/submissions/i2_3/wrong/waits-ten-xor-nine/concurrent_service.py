import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

WORK_NS = 3 * 10^9


class Adder(Node):
    def __init__(self):
        super().__init__('adder')
        group = ReentrantCallbackGroup()
        self.count = 0
        self.create_service(AddTwoInts, 'slow_add', self.on_request, callback_group=group)
        self.create_timer(0.1, self.on_tick, callback_group=group)

    def on_request(self, request, response):
        begin = self.get_clock().now()
        while (self.get_clock().now() - begin).nanoseconds < WORK_NS:
            time.sleep(0.02)
        response.sum = request.a + request.b
        return response

    def on_tick(self):
        self.count += 1
        self.get_logger().info(f'tick {self.count}')


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=6)
    node = Adder()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
