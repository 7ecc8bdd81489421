#!/usr/bin/env python3
"""Publishes simulated temperature readings on /sensor/temperature."""

import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from example_interfaces.msg import Float64


class TemperaturePublisher(Node):
    """A thermometer that makes up its readings."""

    def __init__(self) -> None:
        super().__init__("temperature_publisher")
        # 2.0, not 2: the type of the default becomes the type of the parameter.
        rate = self.declare_parameter("publish_rate", 2.0).value
        self.sensor_name = self.declare_parameter("sensor_name", "thermometer_1").value

        self.publisher = self.create_publisher(Float64, "/sensor/temperature", 10)
        # A timer takes the seconds between two calls, a rate is calls per second: each is 1 / the other.
        self.timer = self.create_timer(1.0 / rate, self.timer_callback)
        self.get_logger().info(f"{self.sensor_name} publishes {rate} readings per second")

    def timer_callback(self) -> None:
        """Publish one reading."""
        reading = Float64(data=random.uniform(20.0, 30.0))
        self.publisher.publish(reading)
        self.get_logger().info(f"{self.sensor_name}: {reading.data:.2f} °C")


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
