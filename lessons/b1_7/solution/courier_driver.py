#!/usr/bin/env python3
"""The courier's driver: drives to goals, and says where it is."""

import threading

import rclpy
from geometry_msgs.msg import Point
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import (
    ExternalShutdownException,
    MultiThreadedExecutor,
)
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

POSITION_HZ = 10.0
STEP_S = 0.05

LATCHED = QoSProfile(
    depth=1,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
"""Also gets a goal that was sent before this node started."""


class Driver(Node):
    """Drives along the corridor. Parameter: the speed, in m/s."""

    def __init__(self) -> None:
        super().__init__("driver")
        self.speed = self.declare_parameter("speed", 0.1).value
        self.x = 0.0
        self.stopping = threading.Event()

        self.positions = self.create_publisher(Point, "position", 10)
        self.create_timer(1.0 / POSITION_HZ, self.report)
        driving = MutuallyExclusiveCallbackGroup()
        self.create_subscription(
            Point,
            "goal",
            self.drive,
            LATCHED,
            callback_group=driving,
        )

    def drive(self, goal: Point) -> None:
        """Drive to a goal, step by step; returns on arrival."""
        step = self.speed * STEP_S
        while abs(goal.x - self.x) > step:
            if self.stopping.wait(STEP_S):
                return
            self.x += step if goal.x > self.x else -step
        self.x = goal.x

    def report(self) -> None:
        """Say where the robot is."""
        self.positions.publish(Point(x=self.x))


def main() -> None:
    """Run the node until Ctrl+C, also in the middle of a drive."""
    rclpy.init()
    driver = Driver()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(driver)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        driver.stopping.set()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
