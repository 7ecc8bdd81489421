import time
import traceback

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


def main():
    rclpy.init()
    node = Node('concurrent_service')
    group = ReentrantCallbackGroup()
    ticks = 0

    def add(request, response):
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response

    def tick():
        nonlocal ticks
        ticks += 1
        if ticks % 10 == 0:
            node.get_logger().info(f'tick {ticks}')

    node.create_service(AddTwoInts, 'slow_add', add, callback_group=group)
    node.create_timer(0.1, tick, callback_group=group)
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)
    try:
        executor.spin()
    except BaseException:
        print(traceback.format_exc())
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
