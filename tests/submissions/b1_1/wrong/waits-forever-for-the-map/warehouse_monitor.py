import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSPresetProfiles
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import Int32, String


class WarehouseMonitor(Node):
    def __init__(self):
        super().__init__("warehouse_monitor")

    def fetch_map(self):
        found, message = wait_for_message(String, self, "map")
        if found:
            self.get_logger().info(f"working on {message.data}")
        else:
            self.get_logger().error("there is no map")

    def listen(self):
        self.create_subscription(Int32, "range", self.on_range, QoSPresetProfiles.SENSOR_DATA.value)
        self.create_subscription(String, "parcels", self.on_parcel, 1000)

    def on_range(self, message):
        self.get_logger().info(f"{message.data} mm ahead")

    def on_parcel(self, message):
        self.get_logger().info(f"got {message.data}")


def main():
    rclpy.init()
    node = WarehouseMonitor()
    try:
        node.fetch_map()
        node.listen()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
