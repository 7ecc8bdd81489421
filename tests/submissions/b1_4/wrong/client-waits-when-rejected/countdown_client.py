import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.node import Node


class CountdownClient(Node):
    def __init__(self):
        super().__init__('countdown_client')
        self._client = ActionClient(self, Fibonacci, 'countdown')

    def send_goal(self):
        self._client.wait_for_server()
        future = self._client.send_goal_async(Fibonacci.Goal(order=5), feedback_callback=self.feedback_callback)
        future.add_done_callback(self.goal_response_callback)

    def goal_response_callback(self, future):
        goal_handle = future.result()
        if not goal_handle.accepted:
            self.get_logger().info('Goal rejected :(')
            return
        self.get_logger().info('Goal accepted :)')
        goal_handle.get_result_async().add_done_callback(self.get_result_callback)
        self.goal_handle = goal_handle

    def feedback_callback(self, feedback_msg):
        self.get_logger().info(f'Received feedback: {feedback_msg.feedback.sequence}')

    def get_result_callback(self, future):
        self.get_logger().info(f'Result: {future.result().result.sequence}')
        rclpy.shutdown()


def main():
    rclpy.init()
    client = CountdownClient()
    client.send_goal()
    rclpy.spin(client)


main()
