#!/usr/bin/env python3
"""Exercise I1.1: publish simulated temperature readings."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# TODO 1: import random, and import Float64 from std_msgs.msg.


class TemperaturePublisher(Node):
    """A thermometer that makes up its readings."""

    def __init__(self) -> None:
        super().__init__("temperature_publisher")
        # TODO 2: create a publisher of Float64 on /sensor/temperature,
        #         with a queue of 10 messages.

        # TODO 3: declare the parameter publish_rate (a float, in
        #         messages per second) and read its value.

        # TODO 4: declare the parameter sensor_name (a string) and keep
        #         its value for the log messages.

        # TODO 5: create a timer that calls self.timer_callback
        #         publish_rate times per second.

    def timer_callback(self) -> None:
        """Publish one reading. The timer calls this."""
        # TODO 6: make a Float64 and give it a random temperature
        #         between 20.0 and 30.0.

        # TODO 7: publish it.

        # TODO 8: log it, together with the sensor's name.


def main() -> None:
    """Run the node until Ctrl+C. This part is complete."""
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
