#!/usr/bin/env python3
"""Exercise I2.1: a publisher that can be tuned while it runs."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    """Publishes "Hello #0", "Hello #1", ... once a second.

    So far, nothing about it can be changed.
    """

    def __init__(self) -> None:
        super().__init__("parameterized_publisher")
        self.count = 0
        self.publisher = self.create_publisher(String, "chatter", 10)

        # TODO 1: declare the parameters message_prefix ("Hello"),
        #         publish_rate (1.0) and enabled (True).

        # TODO 2: let the timer run at publish_rate. A timer wants
        #         seconds between two calls, not calls per second.
        self.timer = self.create_timer(1.0, self.timer_callback)

        # TODO 4: register a callback that refuses a bad publish_rate:
        #         add_on_set_parameters_callback(). It must return a
        #         SetParametersResult, from rcl_interfaces.msg.

        # TODO 5: register a callback that replaces the timer when
        #         publish_rate has changed:
        #         add_post_set_parameters_callback().

    def timer_callback(self) -> None:
        """Publish one message. The timer calls this."""
        # TODO 3: use the value of message_prefix, and publish nothing
        #         while enabled is false.
        message = String(data=f"Hello #{self.count}")
        self.publisher.publish(message)
        self.get_logger().info(f"Published: {message.data}")
        self.count += 1


def main() -> None:
    """Run the node until Ctrl+C. This part is complete.

    Only the bonus criterion launch-validation needs a change here.
    """
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
