import queue
import threading
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from std_msgs.msg import Int32, String


class WarehouseMonitor(Node):
    def __init__(self):
        super().__init__("warehouse_monitor")
        self.parcels = queue.SimpleQueue()
        self.create_subscription(
            String, "map", self.note, QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        )
        self.create_subscription(Int32, "range", self.note, qos_profile_sensor_data)
        self.create_subscription(String, "parcels", self.parcels.put, 200)
        threading.Thread(target=self.store_parcels, daemon=True).start()

    def note(self, message):
        self.get_logger().info(f"noted: {message.data}")

    def store_parcels(self):
        while True:
            message = self.parcels.get()
            time.sleep(0.005)
            self.get_logger().info(f"stored {message.data}")


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
