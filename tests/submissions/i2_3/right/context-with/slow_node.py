from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node


class SlowNode(Node):
    def __init__(self, work):
        super().__init__('slow_node')
        self.work = work
        self.left = True
        self.create_service(AddTwoInts, 'slow_add', self.slow_add, callback_group=ReentrantCallbackGroup())
        self.create_timer(0.1, self.swing, callback_group=ReentrantCallbackGroup())

    def swing(self):
        self.get_logger().info('⏰ tick' if self.left else '⏰ tock')
        self.left = not self.left

    def slow_add(self, request, response):
        self.get_logger().info(f'🐢 {request.a} + {request.b} ...')
        self.work()
        response.sum = request.a + request.b
        self.get_logger().info(f'✅ {response.sum}')
        return response
