import rclpy
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor
from rclpy.executors import ExternalShutdownException
from rclpy.callback_groups import ReentrantCallbackGroup, MutuallyExclusiveCallbackGroup

from time import sleep

from example_interfaces.srv import AddTwoInts


class MinimalSlowService(Node):
    def __init__(self, name, srv):
        super().__init__(name)
        self.group = MutuallyExclusiveCallbackGroup()
        self.srv = self.create_service(AddTwoInts, srv, self.cb, callback_group=self.group)

    def cb(self, request: AddTwoInts.Request, response: AddTwoInts.Response):
        self.get_logger().info('processing...')
        sleep(3.0)
        response.sum = request.a + request.b
        self.get_logger().info('done')
        return response


class MinimalTicker(Node):
    def __init__(self, name, hz):
        super().__init__(name)
        self.n = 0
        self.group = ReentrantCallbackGroup()
        self.timer = self.create_timer(1 / hz, self.cb, callback_group=self.group)

    def cb(self):
        self.n += 1
        self.get_logger().info(f'tick {self.n}')


def main(args=None):
    rclpy.init(args=args)

    service = MinimalSlowService('slow_service', 'slow_add')
    ticker = MinimalTicker('ticker', 10)

    service_executor = MultiThreadedExecutor(num_threads=2)
    service_executor.add_node(service)

    ticker_executor = MultiThreadedExecutor(num_threads=2)
    ticker_executor.add_node(ticker)

    try:
        service_executor.spin()
        ticker_executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        service.destroy_node()
        ticker.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
