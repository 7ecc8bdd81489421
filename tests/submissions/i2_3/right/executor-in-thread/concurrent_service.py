import threading
import time

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class Concurrent(Node):
    def __init__(self):
        super().__init__('concurrent')
        self.slots = threading.Semaphore(2)
        self.tick_count = 0
        self.create_service(AddTwoInts, 'slow_add', self.slow, callback_group=ReentrantCallbackGroup())
        self.create_timer(0.1, self.on_tick, callback_group=ReentrantCallbackGroup())

    def slow(self, req, res):
        with self.slots:
            time.sleep(3)
        res.sum = req.b + req.a
        return res

    def on_tick(self):
        self.tick_count += 1
        if not self.tick_count % 10:
            self.get_logger().info(f'Tick={self.tick_count}')


def main():
    rclpy.init()
    node = Concurrent()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)

    def spin():
        try:
            executor.spin()
        except ExternalShutdownException:
            pass

    thread = threading.Thread(target=spin, daemon=True)
    thread.start()
    try:
        while rclpy.ok():
            thread.join(0.5)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
        thread.join()


if __name__ == '__main__':
    main()
