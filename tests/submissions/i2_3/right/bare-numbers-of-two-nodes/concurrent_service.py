import time
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from example_interfaces.srv import AddTwoInts

class Adder(Node):
    def __init__(self):
        super().__init__('adder')
        self.create_service(AddTwoInts, '/slow_add', self.add, callback_group=ReentrantCallbackGroup())
    def add(self, rq, rs):
        self.get_logger().warning('busy for three seconds')
        time.sleep(3)
        rs.sum = rq.a + rq.b
        return rs

class Ticker(Node):
    def __init__(self, name, hz, every):
        super().__init__(name)
        self.n = 0
        self.every = every
        self.create_timer(1/hz, self.cb)
    def cb(self):
        self.n += 1
        if self.n % self.every == 0:
            self.get_logger().info(f'{self.n}')

def main():
    rclpy.init()
    ex = MultiThreadedExecutor(num_threads=10)
    nodes = [Adder(), Ticker('fast', 10.0, 10), Ticker('monitor', 2.0, 1)]
    for n in nodes:
        ex.add_node(n)
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    for n in nodes:
        n.destroy_node()
    rclpy.try_shutdown()
main()
