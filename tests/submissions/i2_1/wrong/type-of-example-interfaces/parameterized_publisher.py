#!/usr/bin/env python3
"""Publishes on the topic chatter; prefix, rate and an on/off switch are parameters."""

import sys

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.executors import ExternalShutdownException
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.parameter import Parameter
import example_interfaces.msg

MIN_RATE_HZ = 0.01
MAX_RATE_HZ = 1000.0


class ParameterizedPublisher(Node):
    """Publishes "<message_prefix> #<count>", publish_rate times per second, while enabled is true."""

    def __init__(self) -> None:
        super().__init__("parameterized_publisher")
        # Register this before declaring the parameters, so that values from the command line are checked as well.
        self.add_on_set_parameters_callback(self.check_parameters)
        self.declare_parameter("message_prefix", "Hello")
        self.declare_parameter("publish_rate", 1.0)
        self.declare_parameter("enabled", True)
        self.add_post_set_parameters_callback(self.apply_parameters)

        self.count = 0
        self.publisher = self.create_publisher(example_interfaces.msg.String, "chatter", 10)
        self.rate = self.get_parameter("publish_rate").value
        self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)

    def check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        """Say whether these values may be set. Change nothing yet: another value in the list may still be refused."""
        for parameter in parameters:
            # Written this way so that nan, for which every comparison is false, is refused too.
            if parameter.name == "publish_rate" and not MIN_RATE_HZ <= parameter.value <= MAX_RATE_HZ:
                reason = f"publish_rate must be from {MIN_RATE_HZ} to {MAX_RATE_HZ} Hz, not {parameter.value}"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def apply_parameters(self, parameters: list[Parameter]) -> None:
        """Act on values that have been set. The prefix and enabled need no action: each message looks them up."""
        for parameter in parameters:
            if parameter.name == "publish_rate" and parameter.value != self.rate:
                self.rate = parameter.value
                self.destroy_timer(self.timer)  # Without this, the old timer would keep firing beside the new one.
                self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)

    def timer_callback(self) -> None:
        """Publish one message, unless enabled is false."""
        if not self.get_parameter("enabled").value:
            return
        message = example_interfaces.msg.String(data=f"{self.get_parameter('message_prefix').value} #{self.count}")
        self.publisher.publish(message)
        self.get_logger().info(f"Published: {message.data}")
        self.count += 1


def main() -> None:
    """Run the node until Ctrl+C; exit with code 1 if it was started with a value it cannot use."""
    rclpy.init()
    try:
        rclpy.spin(ParameterizedPublisher())
    except (InvalidParameterTypeException, InvalidParameterValueException) as error:
        # A message that names the parameter helps whoever typed the command; a traceback would not.
        get_logger("parameterized_publisher").fatal(str(error))
        sys.exit(1)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
