#!/usr/bin/env python3
"""Plays a battery: sends ten readings a second, says what happens to it, and begins again after 20 seconds."""

import math
import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState

CHARGING = BatteryState.POWER_SUPPLY_STATUS_CHARGING
DISCHARGING = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING

# For how many seconds, what happens, the charge, the temperature and the status.
SCENES = (
    (3.0, "discharges", 0.62, 25.0, DISCHARGING),
    (4.5, "is low", 0.12, 25.0, DISCHARGING),
    (3.0, "is low, and hot", 0.11, 52.0, DISCHARGING),
    (3.0, "is charged", 0.55, 30.0, CHARGING),
    (2.0, "has lost its sensor", math.nan, 30.0, CHARGING),
    (2.5, "is charged, with its sensor back", 0.70, 28.0, CHARGING),
    (2.0, "sends percents instead of a fraction", 71.0, 28.0, CHARGING),
)
HZ = 10


class Battery(Node):
    """Publishes on /battery, scene by scene."""

    def __init__(self) -> None:
        super().__init__("battery")
        self.publisher = self.create_publisher(BatteryState, "/battery", 10)
        self.scene = -1
        self.left = 0
        self.timer = self.create_timer(1.0 / HZ, self.send)

    def send(self) -> None:
        """Send one reading, and go to the next scene when its time has come."""
        if self.left <= 0:
            self.scene = (self.scene + 1) % len(SCENES)
            self.left = round(SCENES[self.scene][0] * HZ)
            self.get_logger().info(f"The battery {SCENES[self.scene][1]}")
        self.left -= 1
        _, _, charge, temperature, status = SCENES[self.scene]
        noise = random.uniform(-0.01, 0.01)
        self.publisher.publish(
            BatteryState(
                percentage=charge + noise,
                temperature=temperature + 10 * noise,
                power_supply_status=status,
            )
        )


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = Battery()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
