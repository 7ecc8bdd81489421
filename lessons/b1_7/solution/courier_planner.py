#!/usr/bin/env python3
"""The courier's planner: turns an order, a room, into a place."""

import rclpy
from geometry_msgs.msg import Point
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

ROOMS = {"dock": 0.0, "kitchen": 1.0, "lab": 2.0}
"""How far down the corridor each room is, in metres."""

LATCHED = QoSProfile(
    depth=1,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
"""Keeps the last goal for a driver that starts later."""


class Planner(Node):
    """Answers each order with a goal."""

    def __init__(self) -> None:
        super().__init__("planner")
        self.goals = self.create_publisher(Point, "goal", LATCHED)
        self.create_subscription(String, "orders", self.plan, 10)

    def plan(self, order: String) -> None:
        """Publish where the room of an order is."""
        if order.data in ROOMS:
            self.goals.publish(Point(x=ROOMS[order.data]))
        else:
            self.get_logger().warning(f"no room {order.data!r}")


def main() -> None:
    """Run the node until Ctrl+C."""
    rclpy.init()
    try:
        rclpy.spin(Planner())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
