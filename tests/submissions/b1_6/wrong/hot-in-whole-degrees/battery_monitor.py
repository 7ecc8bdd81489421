#!/usr/bin/env python3
import math
import sys
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    def __init__(self):
        super().__init__("battery_monitor")
        self.status = None
        self.outage = False
        self.create_subscription(BatteryState, "/battery", self.on_battery, 10)

    def on_battery(self, battery):
        log = self.get_logger()
        charge = battery.percentage
        if not 0.0 <= charge <= 1.0:
            if not self.outage:
                log.error(f"Outage: the charge is {charge}")
            self.outage = True
            return
        self.outage = False
        log.debug(f"Charge {charge:.2f}")
        log.info("The battery reports", once=True)
        if self.status is not None and self.status != battery.power_supply_status:
            log.info(f"Status {self.status} -> {battery.power_supply_status}")
        self.status = battery.power_supply_status
        if charge < 0.2:
            log.warning(f"Low: {charge:.2f}", throttle_duration_sec=2.0)
        if int(battery.temperature) > 45:
            log.warning(f"Hot: {battery.temperature:.1f}", throttle_duration_sec=2.0)


def main():
    rclpy.init()
    node = BatteryMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
