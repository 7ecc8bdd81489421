import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.exceptions import ROSInterruptException
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class RateService(Node):
    def __init__(self):
        super().__init__('rate_service')
        self.create_service(AddTwoInts, 'slow_add', self.callback, callback_group=MutuallyExclusiveCallbackGroup())
        self.create_timer(0.1, self.tick, callback_group=ReentrantCallbackGroup())

    def tick(self):
        self.get_logger().info('tick')

    def callback(self, request, response):
        rate = self.create_rate(10)
        try:
            for _ in range(30):
                rate.sleep()
        except ROSInterruptException:
            return response
        rate.destroy()
        response.sum = request.a + request.b
        return response


def main():
    rclpy.init()
    node = RateService()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
