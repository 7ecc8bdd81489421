import time
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import *
from rclpy.executors import *
from example_interfaces.srv import AddTwoInts


class N(Node):
    def __init__(self):
        super().__init__('n')
        self.g1 = MutuallyExclusiveCallbackGroup()
        self.g2 = ReentrantCallbackGroup()
        self.running = False
        self.i = 0
        self.s = self.create_service(AddTwoInts, 'slow_add', self.f, callback_group=self.g1)
        self.t = self.create_timer(0.1, self.g, callback_group=self.g2)

    def f(self, req, res):
        self.running = True
        end = time.monotonic() + 3
        x = 0
        while time.monotonic() < end and rclpy.ok():
            x += sum(i * i for i in range(100))
        self.running = False
        res.sum = req.a + req.b
        return res

    def g(self):
        self.i += 1
        if self.i % 20 == 0:
            self.get_logger().info(f'timer: {self.i} ({"BUSY" if self.running else "idle"})')


if __name__ == '__main__':
    rclpy.init()
    n = N()
    e = MultiThreadedExecutor(4)
    e.add_node(n)
    try:
        e.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
