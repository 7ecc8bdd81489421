import math
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class Monitor(Node):
    def __init__(self):
        super().__init__("monitor")
        self.seen_any = False
        self.last_status = -1
        self.broken = False
        self.last_low = -math.inf
        self.last_hot = -math.inf
        self.create_subscription(BatteryState, "battery", self.callback, 10)
        self.get_logger().info("waiting for the battery")

    def callback(self, msg):
        now = time.monotonic()
        p = msg.percentage
        if math.isnan(p) or p < 0 or p > 1:
            if not self.broken:
                self.get_logger().error("broken reading: %s" % p)
                self.broken = True
            return
        if self.broken:
            self.broken = False
            self.get_logger().info("readings are fine again")
        self.get_logger().debug("charge=%.3f temperature=%.1f" % (p, msg.temperature))
        if not self.seen_any:
            self.seen_any = True
            self.get_logger().info("first reading")
        elif msg.power_supply_status != self.last_status:
            self.get_logger().info("status %d -> %d" % (self.last_status, msg.power_supply_status))
        self.last_status = msg.power_supply_status
        if p < 0.2 and now - self.last_low >= 2:
            self.last_low = now
            self.get_logger().warn("low")
        if msg.temperature > 45 and now - self.last_hot >= 2:
            self.last_hot = now
            self.get_logger().warn("hot")


def main():
    rclpy.init()
    node = Monitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
