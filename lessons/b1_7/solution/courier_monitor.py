#!/usr/bin/env python3
"""The courier's monitor: a line a second for those who watch it."""

import rclpy
from geometry_msgs.msg import Point
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState
from std_msgs.msg import String

STATUS_PERIOD_S = 1.0


class Monitor(Node):
    """Sums up battery and position.

    Parameter: the charge (0 to 1) below which the battery is low.
    """

    def __init__(self) -> None:
        super().__init__("monitor")
        self.low_below = self.declare_parameter("low_below", 0.1).value
        self.charge = None
        self.x = None

        self.statuses = self.create_publisher(String, "status", 10)
        self.create_subscription(
            BatteryState,
            "battery_state",
            self.keep_charge,
            qos_profile_sensor_data,
        )
        self.create_subscription(
            Point,
            "position",
            self.keep_position,
            10,
        )
        self.create_timer(STATUS_PERIOD_S, self.publish_status)

    def keep_charge(self, reading: BatteryState) -> None:
        """Keep the newest reading of the battery."""
        self.charge = reading.percentage

    def keep_position(self, position: Point) -> None:
        """Keep the newest position."""
        self.x = position.x

    def publish_status(self) -> None:
        """Say how the robot is."""
        place, battery = "position unknown", "battery unknown"
        if self.x is not None:
            place = f"at {self.x:.1f} m"
        if self.charge is not None:
            low = self.charge < self.low_below
            battery = "battery low" if low else "battery ok"
        self.statuses.publish(String(data=f"{battery}, {place}"))


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    try:
        rclpy.spin(Monitor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
