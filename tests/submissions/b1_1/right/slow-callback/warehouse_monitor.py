import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String


class WarehouseMonitor(Node):
    def __init__(self):
        super().__init__("warehouse_monitor")
        latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(String, "/map", lambda m: self.log("map", m), latched)
        lossy = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.create_subscription(Int32, "/range", lambda m: self.log("range", m), lossy)
        self.create_subscription(String, "/parcels", self.on_parcel, 1000)
        self.create_timer(1.0, self.alive)

    def log(self, what, message):
        self.get_logger().info(f"{what}: {message.data}")

    def on_parcel(self, message):
        time.sleep(0.01)
        self.log("parcel", message)

    def alive(self):
        self.get_logger().info("still here")


def main():
    rclpy.init()
    node = WarehouseMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
