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

        self.create_service(AddTwoInts, 'slow_add', self.add, callback_group=ReentrantCallbackGroup())
        self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())

    def tick(self):
        self.i += 1
        self.get_logger().info(f'tick {self.i}')

    def add(self, req, res):
        time.sleep(3)
        res.sum = req.a + req.b
        return res


class T(Node):
    def __init__(self):
        super().__init__('t')
        self.i = 0
        self.create_timer(1.0, self.t)
    def t(self):
        self.i += 10
        self.get_logger().debug('x')

def main():
    rclpy.init()
    n, t = S(), T()
    a, b = MultiThreadedExecutor(5), SingleThreadedExecutor()
    a.add_node(n); b.add_node(t)
    def other():
        try:
            b.spin()
        except ExternalShutdownException:
            pass
    th = threading.Thread(target=other); th.start()
    try:
        a.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    th.join(1)
    rclpy.try_shutdown()
main()
