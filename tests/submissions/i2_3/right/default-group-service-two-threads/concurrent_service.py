import rclpy
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from example_interfaces.srv import AddTwoInts
from time import sleep


class Slow(Node):
    def __init__(self):
        super().__init__('slow')
        self.n = 0
        self.create_service(AddTwoInts, '/slow_add', self.add)
        self.fast = MutuallyExclusiveCallbackGroup()
        self.create_timer(0.1, self.cb, self.fast)

    def cb(self):
        self.n = self.n + 1
        self.get_logger().info('tick %d' % self.n)

    def add(self, request, response):
        sleep(3)
        response.sum = request.a + request.b
        return response


def main(args=None):
    rclpy.init(args=args)
    n = Slow()
    try:
        rclpy.spin(n, MultiThreadedExecutor())
    except KeyboardInterrupt:
        pass
    except ExternalShutdownException:
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
