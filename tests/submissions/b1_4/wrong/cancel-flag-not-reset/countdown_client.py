import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from example_interfaces.action import Fibonacci


class CountdownClient(Node):
    def __init__(self):
        super().__init__("countdown_client")
        self.client = ActionClient(self, Fibonacci, "countdown")

    def on_feedback(self, message):
        self.get_logger().info(f"Counting: {message.feedback.sequence[-1]}")

    def run(self):
        self.client.wait_for_server()
        goal = Fibonacci.Goal(order=5)
        sent = self.client.send_goal_async(goal, feedback_callback=self.on_feedback)
        rclpy.spin_until_future_complete(self, sent)
        handle = sent.result()
        if not handle.accepted:
            self.get_logger().error("The goal was rejected")
            return
        ended = handle.get_result_async()
        rclpy.spin_until_future_complete(self, ended)
        self.get_logger().info(f"Result: {list(ended.result().result.sequence)}")


def main():
    rclpy.init()
    node = CountdownClient()
    try:
        node.run()
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
