import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future


class ConcurrentService(Node):
    def __init__(self):
        super().__init__('concurrent_service')
        self.reentrant = ReentrantCallbackGroup()
        self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=self.reentrant)
        self.create_timer(0.1, self.fast_timer, callback_group=self.reentrant)
        self.ticks = 0

    def fast_timer(self):
        self.ticks += 1
        self.get_logger().info(f'ticks so far: {self.ticks}')

    async def wait(self, seconds):
        future = Future()
        timer = self.create_timer(seconds, lambda: future.done() or future.set_result(None),
                                  callback_group=self.reentrant)
        await future
        self.destroy_timer(timer)

    async def slow_add(self, request, response):
        await self.wait(3.0)
        response.sum = request.a + request.b
        return response


def main():
    rclpy.init()
    node = ConcurrentService()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
