#!/usr/bin/env python3
"""Exercise I2.1: a publisher that can be tuned while it runs."""

import sys
from typing import Any, Callable, Dict, List, Optional

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String


class ValidationError(ValueError):
    """A parameter has a value that makes no sense."""


def positive(name: str, value: float) -> None:
    """Insist on a value above zero."""
    if value <= 0.0:
        raise ValidationError(f"{name} must be greater than 0, not {value}")


VALIDATORS: Dict[str, Callable[[str, Any], None]] = {
    "publish_rate": positive,
}


class ParameterizedPublisher(Node):
    """Publishes "<prefix> #0", "<prefix> #1", ... at publish_rate."""

    def __init__(self) -> None:
        super().__init__("parameterized_publisher")
        self.count = 0
        self.publisher = self.create_publisher(String, "chatter", 10)

        self.add_on_set_parameters_callback(self.validate)
        self.declare_parameter("message_prefix", "Hello")
        self.declare_parameter("publish_rate", 1.0)
        self.declare_parameter("enabled", True)

        self.timer = self.new_timer()
        self.add_post_set_parameters_callback(self.react)

    def new_timer(self):
        """Make a timer that runs at the current rate."""
        rate = self.get_parameter("publish_rate").value
        return self.create_timer(1.0 / rate, self.timer_callback)

    def validate(self, parameters: List[Parameter]) -> SetParametersResult:
        """Look at all values before any of them is stored."""
        for parameter in parameters:
            validator = VALIDATORS.get(parameter.name)
            if validator is not None:
                validator(parameter.name, parameter.value)
        return SetParametersResult(successful=True)

    def react(self, parameters: List[Parameter]) -> None:
        """Do what new values require."""
        if any(p.name == "publish_rate" for p in parameters):
            self.destroy_timer(self.timer)
            self.timer = self.new_timer()

    def timer_callback(self) -> None:
        """Publish one message. The timer calls this."""
        if not self.get_parameter("enabled").value:
            return
        prefix = self.get_parameter("message_prefix").value
        message = String(data=f"{prefix} #{self.count}")
        self.publisher.publish(message)
        self.get_logger().info(f"Published: {message.data}")
        self.count += 1


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node: Optional[ParameterizedPublisher] = None
    failed = False
    try:
        node = ParameterizedPublisher()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except ValidationError as error:
        rclpy.logging.get_logger("parameterized_publisher").fatal(str(error))
        failed = True
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    if failed:
        sys.exit(1)


if __name__ == "__main__":
    main()
