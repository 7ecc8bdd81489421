import sys

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.node import Node


class Client(Node):
    def __init__(self):
        super().__init__('client')
        self.exit_code = None
        self.client = ActionClient(self, Fibonacci, 'countdown')
        self.look = self.create_timer(0.2, self.start)

    def start(self):
        if not self.client.server_is_ready():
            self.get_logger().info('no server yet', throttle_duration_sec=1)
            return
        self.look.cancel()
        self.client.send_goal_async(
            Fibonacci.Goal(order=6), feedback_callback=self.on_feedback
        ).add_done_callback(self.on_answer)

    def on_feedback(self, msg):
        self.get_logger().info('so far: ' + ', '.join(str(n) for n in msg.feedback.sequence))

    def on_answer(self, future):
        if future.result().accepted:
            future.result().get_result_async().add_done_callback(self.on_result)
            self.goal = future.result()
        else:
            self.get_logger().fatal('abgelehnt')
            self.exit_code = 3

    def on_result(self, future):
        self.get_logger().info('all: ' + ', '.join(str(n) for n in future.result().result.sequence))
        self.exit_code = 0


rclpy.init()
client = Client()
while client.exit_code is None:
    rclpy.spin_once(client)
client.destroy_node()
rclpy.shutdown()
sys.exit(client.exit_code)
