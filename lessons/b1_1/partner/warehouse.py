#!/usr/bin/env python3
"""The given warehouse: a map that is published once, a lossy range sensor, and parcels that come in bursts."""

import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String

PARCELS_AT_ONCE = 200


class Warehouse(Node):
    """Publishes what a warehouse knows, whether anyone listens or not."""

    def __init__(self) -> None:
        super().__init__("warehouse")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        lossy = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.map_publisher = self.create_publisher(String, "map", latched)
        self.range_publisher = self.create_publisher(Int32, "range", lossy)
        self.parcel_publisher = self.create_publisher(String, "parcels", PARCELS_AT_ONCE)
        self.lorries = 0
        name = f"hall-{random.randint(1, 9)}"
        self.map_publisher.publish(String(data=name))
        self.get_logger().info(f"Published the map {name}, and never again")
        self.create_timer(0.2, self.measure)
        self.create_timer(10.0, self.unload)

    def measure(self) -> None:
        """Publish one reading of the sensor."""
        self.range_publisher.publish(Int32(data=random.randint(300, 4000)))

    def unload(self) -> None:
        """Publish all parcels of a lorry at once."""
        self.lorries += 1
        labels = [f"lorry-{self.lorries}-{number:03}" for number in range(1, PARCELS_AT_ONCE + 1)]
        for label in labels:
            self.parcel_publisher.publish(String(data=label))
        self.get_logger().info(f"Published {len(labels)} parcels at once: {labels[0]} to {labels[-1]}")


def main() -> None:
    """Run the warehouse until Ctrl+C."""
    rclpy.init()
    node = Warehouse()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C: not an error worth a traceback.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
