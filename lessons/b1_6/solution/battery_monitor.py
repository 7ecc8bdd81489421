#!/usr/bin/env python3
"""Watches a battery, and logs each event at the level that it deserves."""

import math

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState

LOW = 0.2
HOT = 45.0
PERIOD_S = 2.0

STATUSES = {
    BatteryState.POWER_SUPPLY_STATUS_UNKNOWN: "unknown",
    BatteryState.POWER_SUPPLY_STATUS_CHARGING: "charging",
    BatteryState.POWER_SUPPLY_STATUS_DISCHARGING: "discharging",
    BatteryState.POWER_SUPPLY_STATUS_NOT_CHARGING: "not charging",
    BatteryState.POWER_SUPPLY_STATUS_FULL: "full",
}


class BatteryMonitor(Node):
    """Watches a battery, and logs what a person on call must know."""

    def __init__(self) -> None:
        super().__init__("battery_monitor")
        self.status: int | None = None
        self.outage = False
        self.subscription = self.create_subscription(BatteryState, "/battery", self.on_battery, 10)

    def on_battery(self, battery: BatteryState) -> None:
        """Handle one reading."""
        charge = battery.percentage
        # NaN is neither below 0 nor above 1: only a test that it is inside the range finds it.
        if not 0.0 <= charge <= 1.0:
            self.on_broken_reading(charge)
            return
        self.outage = False
        logger = self.get_logger()
        logger.debug(f"{charge:.0%}, {battery.temperature:.1f} °C")
        logger.info("The battery reports", once=True)
        self.on_status(battery.power_supply_status)
        # Each of these lines has a throttle of its own: one does not hold back the other.
        if charge < LOW:
            logger.warning(f"The battery is low: {charge:.0%}", throttle_duration_sec=PERIOD_S)
        if battery.temperature > HOT:
            logger.warning(f"The battery is hot: {battery.temperature:.1f} °C", throttle_duration_sec=PERIOD_S)

    def on_broken_reading(self, charge: float) -> None:
        """Log the first broken reading of an outage."""
        if not math.isnan(charge):
            reason = f"a charge of {charge:g} is not from 0 to 1"
        else:
            reason = "the charge is not a number"
        if not self.outage:
            self.get_logger().error(f"Broken readings: {reason}")
        self.outage = True

    def on_status(self, status: int) -> None:
        """Log a status that differs from the one before."""
        before, self.status = self.status, status
        if before is not None and status != before:
            self.get_logger().info(f"The battery is {STATUSES.get(status, status)}")


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = BatteryMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
