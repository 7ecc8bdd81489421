from math import isfinite

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    def __init__(self):
        super().__init__("battery_monitor")
        log = self.get_logger()
        self.raw, self.alarm, self.state = (log.get_child(name) for name in ("raw", "alarm", "state"))
        self.status = None
        self.ok = True
        self.sub = self.create_subscription(BatteryState, "/battery", self.on_reading, 50)

    def on_reading(self, msg):
        ok = isfinite(msg.percentage) and 0 <= msg.percentage <= 1
        if not ok and self.ok:
            self.alarm.error(f"implausible charge {msg.percentage}")
        self.ok = ok
        if not ok:
            return
        self.raw.debug(f"{100 * msg.percentage:.1f} %")
        if self.status is None:
            self.state.info("online", once=True)
        if msg.power_supply_status != self.status:
            self.state.info(f"status is now {msg.power_supply_status}")
            self.status = msg.power_supply_status
        if msg.percentage < 0.2:
            self.alarm.warning("low charge", throttle_duration_sec=2.0)
        if msg.temperature > 45.0:
            self.alarm.warning("high temperature", throttle_duration_sec=2.0)


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
