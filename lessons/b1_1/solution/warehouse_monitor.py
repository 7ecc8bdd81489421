#!/usr/bin/env python3
"""Logs everything that a warehouse publishes, with the QoS that each publisher calls for."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String

# Published once, before we joined: the publisher keeps it, and hands it to whoever asks.
MAP_QOS = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)

# The sensor offers best effort: a subscription that asks for more is not connected.
RANGE_QOS = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)

# 200 at once must fit in the queue while the callback handles the first of them.
PARCELS_QOS = QoSProfile(depth=200, reliability=ReliabilityPolicy.RELIABLE)


class WarehouseMonitor(Node):
    """Listens to a warehouse that was there first."""

    def __init__(self) -> None:
        super().__init__("warehouse_monitor")
        self.create_subscription(String, "map", self.on_map, MAP_QOS)
        self.create_subscription(Int32, "range", self.on_range, RANGE_QOS)
        self.create_subscription(String, "parcels", self.on_parcel, PARCELS_QOS)
        self.get_logger().info("Waiting for the warehouse")

    def on_map(self, message: String) -> None:
        """Log the map."""
        self.get_logger().info(f"map: {message.data}")

    def on_range(self, message: Int32) -> None:
        """Log one reading of the sensor."""
        self.get_logger().info(f"range: {message.data} mm")

    def on_parcel(self, message: String) -> None:
        """Log one parcel."""
        self.get_logger().info(f"parcel: {message.data}")


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    node = WarehouseMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
