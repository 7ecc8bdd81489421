#!/usr/bin/env python3
"""Exercise I2.1: a publisher that can be tuned while it runs."""

import sys

import rclpy
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class BadRateError(Exception):
    """The node was started with an impossible rate."""


class ParameterizedPublisher(Node):
    """Publishes "Hello #0", "Hello #1", ..., and can be reconfigured."""

    def __init__(self) -> None:
        super().__init__("parameterized_publisher")
        self.count = 0
        self.timer = None
        self.publisher = self.create_publisher(String, "chatter", 10)

        self.declare_parameter(
            "message_prefix",
            "Hello",
            ParameterDescriptor(description="Start of each message"),
        )
        self.declare_parameter(
            "publish_rate",
            1.0,
            ParameterDescriptor(description="Messages per second, above 0"),
        )
        self.declare_parameter(
            "enabled",
            True,
            ParameterDescriptor(description="Publish at all?"),
        )

        if self.publish_rate <= 0.0:
            raise BadRateError(
                f"publish_rate must be positive, got {self.publish_rate}"
            )

        self.start_timer()
        self.add_on_set_parameters_callback(self.on_parameters)

    @property
    def publish_rate(self) -> float:
        """The current rate in messages per second."""
        return self.get_parameter("publish_rate").value

    @property
    def message_prefix(self) -> str:
        """The current start of each message."""
        return self.get_parameter("message_prefix").value

    @property
    def enabled(self) -> bool:
        """Whether to publish."""
        return self.get_parameter("enabled").value

    def start_timer(self) -> None:
        """Start the timer, in place of the old one if there is one."""
        if self.timer is not None:
            self.destroy_timer(self.timer)
        self.timer = self.create_timer(
            1.0 / self.publish_rate, self.timer_callback
        )

    def on_parameters(self, parameters) -> SetParametersResult:
        """Dynamic reconfigure: first check everything, then act."""
        rate_changed = False
        for parameter in parameters:
            if parameter.name == "publish_rate":
                if parameter.value <= 0.0:
                    return SetParametersResult(
                        successful=False,
                        reason="publish_rate must be positive, "
                        f"got {parameter.value}",
                    )
                rate_changed = True

        if rate_changed:
            self.start_timer()
        return SetParametersResult(successful=True)

    def timer_callback(self) -> None:
        """Publish one message. The timer calls this."""
        if not self.enabled:
            return
        message = String()
        message.data = f"{self.message_prefix} #{self.count}"
        self.publisher.publish(message)
        self.get_logger().info(f"Published: {message.data}")
        self.count += 1


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = None
    exit_code = 0
    try:
        node = ParameterizedPublisher()
        rclpy.spin(node)
    except BadRateError as error:
        rclpy.logging.get_logger("parameterized_publisher").fatal(str(error))
        exit_code = 1
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    sys.exit(exit_code)


if __name__ == "__main__":
    main()
