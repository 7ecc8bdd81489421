import time
from dataclasses import dataclass
from typing import Callable

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


@dataclass
class Alarm:
    applies: Callable[[BatteryState], bool]
    text: str
    period: float = 2.0
    last: float = float("-inf")

    def look(self, battery, warn):
        if self.applies(battery) and time.monotonic() >= self.last + self.period:
            self.last = time.monotonic()
            warn(self.text.format(battery))


@dataclass
class Edge:
    value: object = None

    def changed(self, value):
        before, self.value = self.value, value
        return before is not None and before != value


class BatteryMonitor(Node):
    def __init__(self):
        super().__init__("battery_monitor")
        self.first = True
        self.outage = Edge(False)
        self.status_edge = Edge()
        self.alarms = [
            Alarm(lambda b: b.percentage < 0.2, "low: {0.percentage:.2f}"),
            Alarm(lambda b: b.temperature > 45, "hot: {0.temperature:.1f}"),
        ]
        self.create_subscription(BatteryState, "/battery", self.receive, 10)

    def receive(self, battery):
        log = self.get_logger()
        bad = not 0 <= battery.percentage <= 1
        if self.outage.changed(bad) and bad:
            log.error("no charge")
        if bad:
            return
        log.debug(f"charge {battery.percentage:.1%}")
        if self.first:
            log.info("battery found")
            self.first = False
        if self.status_edge.changed(battery.power_supply_status):
            log.info(f"status {battery.power_supply_status}")
        for alarm in self.alarms:
            alarm.look(battery, self.warn)

    def warn(self, text):
        self.get_logger().warning(text)


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
