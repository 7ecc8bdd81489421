#!/usr/bin/env python3
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    def __init__(self):
        super().__init__("battery_monitor")
        self.status = None
        self.outage = False
        self.good = 3
        self.create_subscription(BatteryState, "/battery", self.on_battery, 10)

    def on_battery(self, m):
        log = self.get_logger()
        if not 0.0 <= m.percentage <= 1.0:
            self.good = 0
            if not self.outage:
                log.error("broken")
            self.outage = True
            return
        self.outage = False
        log.info("first", once=True)
        log.debug(f"charge {m.percentage:.2f}")
        if self.status is not None and m.power_supply_status != self.status:
            log.info("changed")
        self.status = m.power_supply_status
        if m.percentage < 0.2:
            log.warning("low", throttle_duration_sec=2.0)
        if m.temperature > 45.0:
            log.warning("hot", throttle_duration_sec=2.0)
        if m.percentage < 0.2 or m.temperature > 45.0:
            self.good = 0
        else:
            self.good += 1
            if self.good == 3:
                log.info("All is well again")



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
