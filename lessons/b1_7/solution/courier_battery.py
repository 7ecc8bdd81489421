#!/usr/bin/env python3
"""The courier's battery: its charge, once the sensor is warm."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState

WARM_UP_S = 0.5


class Battery(Node):
    """Publishes what is left of the charge.

    Parameters: charge (0 to 1), loss each second, rate in Hz.
    """

    def __init__(self) -> None:
        super().__init__("battery")
        self.charge = self.declare_parameter("charge", 1.0).value
        self.loss = self.declare_parameter("loss", 0.0001).value
        self.rate = self.declare_parameter("rate", 2.0).value
        self.warm = False

        self.readings = self.create_publisher(
            BatteryState,
            "battery_state",
            qos_profile_sensor_data,
        )
        self.warm_up_timer = self.create_timer(WARM_UP_S, self.warm_up)
        self.reading_timer = self.create_timer(1 / self.rate, self.read)

    def warm_up(self) -> None:
        """Run once: from now on, the readings are good."""
        self.warm = True
        self.warm_up_timer.cancel()

    def read(self) -> None:
        """Publish one reading."""
        if not self.warm:
            return
        self.charge = max(0.0, self.charge - self.loss / self.rate)
        reading = BatteryState(percentage=self.charge, present=True)
        reading.header.stamp = self.get_clock().now().to_msg()
        self.readings.publish(reading)


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    try:
        rclpy.spin(Battery())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
