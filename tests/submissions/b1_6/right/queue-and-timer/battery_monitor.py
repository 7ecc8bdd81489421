from collections import deque

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    def __init__(self):
        super().__init__("battery_monitor")
        self.queue = deque()
        self.status, self.outage = None, False
        self.create_subscription(BatteryState, "/battery", self.collect, 10)
        self.create_timer(0.02, self.work)

    def collect(self, reading):
        self.queue.append(reading)

    def work(self):
        while self.queue:
            self.look_at(self.queue.popleft())

    def look_at(self, reading):
        log = self.get_logger()
        if not (0.0 <= reading.percentage <= 1.0):
            if not self.outage:
                log.error("outage")
            self.outage = True
            return
        self.outage = False
        log.debug(f"reading: {reading.percentage * 100:.0f} %")
        log.info("first reading", once=True)
        if self.status is not None and reading.power_supply_status != self.status:
            log.info("status: " + str(reading.power_supply_status))
        self.status = reading.power_supply_status
        if reading.percentage < 0.2:
            log.warning("low", throttle_duration_sec=2.0)
        if reading.temperature > 45:
            log.warning("hot", throttle_duration_sec=2.0)


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
