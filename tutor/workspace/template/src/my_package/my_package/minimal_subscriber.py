"""The smallest useful subscriber: logs every text that arrives on the topic `chatter`."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MinimalSubscriber(Node):
    """Logs what it hears."""

    def __init__(self):
        super().__init__("minimal_subscriber")
        self.subscription = self.create_subscription(String, "chatter", self.on_message, 10)

    def on_message(self, message):
        """Log one message."""
        self.get_logger().info(f'I heard: "{message.data}"')


def main():
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = MinimalSubscriber()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C is the usual way to stop a node
    finally:
        node.destroy_node()
        rclpy.try_shutdown()  # Ctrl+C has shut ROS down already: a plain shutdown() would complain


if __name__ == "__main__":
    main()
