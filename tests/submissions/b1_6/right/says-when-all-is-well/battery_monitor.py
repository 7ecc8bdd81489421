import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class Monitor(Node):
    def __init__(self):
        super().__init__("monitor")
        self.last = None
        self.wrong = set()
        self.said = {}
        self.create_subscription(BatteryState, "battery", self.callback, 10)

    def callback(self, msg):
        ok = 0 <= msg.percentage <= 1
        self.look("broken", not ok)
        if not ok:
            return
        self.get_logger().debug(f"charge {msg.percentage * 100:.1f} %")
        if self.last is None:
            self.get_logger().info(f"first reading, status {msg.power_supply_status}")
        elif msg.power_supply_status != self.last:
            self.get_logger().info(f"status {self.last} -> {msg.power_supply_status}")
        self.last = msg.power_supply_status
        self.look("low", msg.percentage < 0.2)
        self.look("hot", msg.temperature > 45)

    def look(self, what, is_so):
        if is_so:
            now = self.get_clock().now().nanoseconds
            if what == "broken" and what not in self.wrong:
                self.get_logger().error("broken readings")
            elif what != "broken" and now - self.said.get(what, -(10**10)) >= 2 * 10**9:
                self.said[what] = now
                self.get_logger().warning(f"the battery is {what}")
            self.wrong.add(what)
        elif what in self.wrong:
            self.wrong.remove(what)
            self.get_logger().info(f"no longer {what}")


def main():
    rclpy.init()
    try:
        rclpy.spin(Monitor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
