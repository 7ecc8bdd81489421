#!/usr/bin/env python3
"""Publishes the level of a tank as my_interfaces/msg/Reading, and says whether a value is in a range."""

import math

import rclpy
from my_interfaces.msg import Reading
from my_interfaces.srv import InRange
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

PERIOD_S = 0.2


class TankSensor(Node):
    """A tank whose level rises and falls."""

    def __init__(self) -> None:
        super().__init__("tank_sensor")
        self.readings = 0
        self.publisher = self.create_publisher(Reading, "/tank/reading", 10)
        self.create_service(InRange, "/tank/in_range", self.in_range)
        self.create_timer(PERIOD_S, self.publish_reading)

    def publish_reading(self) -> None:
        """Publish the level, and when it was measured."""
        reading = Reading(sensor="tank", unit="percent")
        reading.header.stamp = self.get_clock().now().to_msg()
        reading.value = 50.0 + 40.0 * math.sin(self.readings / 10.0)
        self.readings += 1
        self.publisher.publish(reading)

    def in_range(self, request: InRange.Request, response: InRange.Response) -> InRange.Response:
        """Answer whether the value is between the limits, or one of them."""
        response.inside = request.low <= request.value <= request.high
        return response


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = TankSensor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
