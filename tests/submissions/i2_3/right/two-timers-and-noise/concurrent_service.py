#!/usr/bin/env python3
import sys
import time
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from example_interfaces.srv import AddTwoInts
from std_srvs.srv import Trigger


class Noisy(Node):
    def __init__(self):
        super().__init__('noisy_service')
        for i in range(300):
            self.get_logger().info(f'loading module {i}')
            print('module', i, 'loaded')
        time.sleep(2)
        cbg = ReentrantCallbackGroup()
        self.count = 0
        self.beats = 0
        self.busy = 0
        self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=cbg)
        self.create_service(AddTwoInts, 'fast_add', self.fast_add, callback_group=cbg)
        self.create_service(Trigger, 'slow_trigger', self.trigger, callback_group=cbg)
        self.create_timer(1.0, self.heartbeat, callback_group=cbg)
        self.create_timer(0.1, self.tick, callback_group=cbg)
        self.get_logger().warning('this is only a test node')

    def heartbeat(self):
        self.beats += 1
        self.get_logger().info(f'heartbeat {self.beats}')

    def tick(self):
        self.count += 1
        print(self.count, file=sys.stderr)
        if self.count % 10 == 0:
            self.get_logger().info(f'tick #{self.count} at {time.time():.2f}, {self.busy} calls running')

    def trigger(self, _, response):
        response.success = True
        return response

    def fast_add(self, request, response):
        response.sum = request.a + request.b
        return response

    def slow_add(self, request, response):
        self.busy += 1
        self.get_logger().info(f'Service called: {request.a} + {request.b}')
        for i in range(30):
            self.get_logger().info(f'working: {100 * (i + 1) // 30} %')
            time.sleep(0.1)
        self.busy -= 1
        response.sum = request.a + request.b
        self.get_logger().info(f'Service complete: {response.sum}')
        return response


def main():
    rclpy.init(args=sys.argv)
    node = Noisy()
    executor = MultiThreadedExecutor(num_threads=5)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown(timeout_sec=1.0)
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
