#!/usr/bin/env python3
"""Exercise B1.6: say what happens to a battery, at the right level."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    """Watches a battery, and logs what a person on call must know."""

    def __init__(self) -> None:
        super().__init__("battery_monitor")
        self.subscription = self.create_subscription(
            BatteryState,
            "/battery",
            self.on_battery,
            10,
        )

    def on_battery(self, battery: BatteryState) -> None:
        """Handle one reading. rclpy calls this for each."""
        # TODO 1: log the reading.


def main() -> None:
    """Run the node until Ctrl+C. This part is complete."""
    rclpy.init()
    node = BatteryMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
