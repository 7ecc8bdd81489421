import time, threading, sys, os
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import *
from rclpy.executors import *
from example_interfaces.srv import AddTwoInts

class S(Node):
    def __init__(self):
        super().__init__('s')
        self.i = 0
        self.active = []
        self.create_service(AddTwoInts, 'slow_add', self.add, callback_group=ReentrantCallbackGroup())
        self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())

    def tick(self):
        self.i += 1
        if self.i % 10 == 0:
            self.get_logger().info(f'active: {self.active} tick {self.i}')

    def add(self, req, res):
        self.active.append((req.a, req.b))
        time.sleep(3)
        self.active.remove((req.a, req.b))
        res.sum = req.a + req.b
        return res


def main():
    rclpy.init()
    n = S()
    ex = MultiThreadedExecutor(num_threads=8)
    ex.add_node(n)
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()

if __name__ == '__main__':
    main()
