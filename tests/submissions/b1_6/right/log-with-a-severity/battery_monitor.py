import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    def __init__(self):
        super().__init__("battery_monitor", namespace="robot")
        self._status = None
        self._outage = False
        self._sub = self.create_subscription(BatteryState, "/battery", self._on_battery, 10)

    def _on_battery(self, m):
        log, clock = self.get_logger(), self.get_clock()
        if not 0.0 <= m.percentage <= 1.0:
            if not self._outage:
                log.log("outage", LoggingSeverity.ERROR)
            self._outage = True
            return
        if self._outage:
            log.log("over", LoggingSeverity.INFO)
        self._outage = False
        log.log(f"reading {m.percentage}", LoggingSeverity.DEBUG)
        log.log("first reading", LoggingSeverity.INFO, once=True)
        if self._status is not None and self._status != m.power_supply_status:
            log.log(f"status {m.power_supply_status}", LoggingSeverity.INFO)
        self._status = m.power_supply_status
        if m.percentage < 0.2:
            log.log("low", LoggingSeverity.WARN, throttle_duration_sec=2.0, throttle_time_source_type=clock)
        if m.temperature > 45.0:
            log.log("hot", LoggingSeverity.WARN, throttle_duration_sec=2.0, throttle_time_source_type=clock)


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
