#!/usr/bin/env python3
"""Exercise B1.1: log everything that a warehouse publishes."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# TODO 1: find out what the publishers offer, with ros2 topic info -v
#         or in Live. Then import what you need from rclpy.qos, and
#         the message types from std_msgs.msg.


class WarehouseMonitor(Node):
    """Listens to a warehouse that was there first."""

    def __init__(self) -> None:
        super().__init__("warehouse_monitor")
        # TODO 2: subscribe to /map (String). It was published before.

        # TODO 3: subscribe to /range (Int32). Its sensor is lossy.

        # TODO 4: subscribe to /parcels (String). 200 come at once.

        self.get_logger().info("Waiting for the warehouse")

    # TODO 5: write the callbacks: one log message for each message,
    #         with its data.


def main() -> None:
    """Run the node until Ctrl+C. This part is complete."""
    rclpy.init()
    node = WarehouseMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
