"""The smallest useful publisher: a counted greeting on the topic `chatter`, twice a second."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MinimalPublisher(Node):
    """Publishes `Hello World: N`, with N rising by one."""

    def __init__(self):
        super().__init__("minimal_publisher")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.timer = self.create_timer(0.5, self.on_timer)
        self.count = 0

    def on_timer(self):
        """Send the next greeting."""
        message = String()
        message.data = f"Hello World: {self.count}"
        self.publisher.publish(message)
        self.get_logger().info(f'Publishing: "{message.data}"')
        self.count += 1


def main():
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = MinimalPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C is the usual way to stop a node
    finally:
        node.destroy_node()
        rclpy.try_shutdown()  # Ctrl+C has shut ROS down already: a plain shutdown() would complain


if __name__ == "__main__":
    main()
