import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class Adder(Node):
    def __init__(self):
        super().__init__('adder')
        self.create_service(AddTwoInts, 'slow_add', self.on_call)

    def on_call(self, request, response):
        self.get_logger().info('Incoming request')
        time.sleep(3)
        response.sum = request.a + request.b
        return response


class Clock(Node):
    def __init__(self):
        super().__init__('fast_timer')
        self.count = 0
        self.create_timer(1 / 10, self.tick)

    def tick(self):
        self.count += 1
        if self.count % 10 == 0:
            self.get_logger().warn(f'[{self.count:05d}] still alive')


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(Adder())
    executor.add_node(Clock())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        print('bye')
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
