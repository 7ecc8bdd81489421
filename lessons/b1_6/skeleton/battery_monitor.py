#!/usr/bin/env python3
"""Exercise B1.6: log what happens to a battery, at the right level."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    """Watches a battery, and logs what a person on call must know."""

    def __init__(self) -> None:
        super().__init__("battery_monitor")
        # TODO 1: what must the node remember from one reading to the
        #         next, to see a change and the start of an outage?
        self.subscription = self.create_subscription(
            BatteryState,
            "/battery",
            self.on_battery,
            10,
        )

    def on_battery(self, battery: BatteryState) -> None:
        """Handle one reading. rclpy calls this for each."""
        # TODO 2: this shows every reading, all day long. Use the level
        #         of what is read only when someone looks for a fault.
        print("reading:", battery.percentage, battery.temperature)

        # TODO 3: say once that the battery reports at all.

        # TODO 4: log a change of battery.power_supply_status.

        # TODO 5: warn of a charge below 0.2, and of more than 45 °C,
        #         each of them at most once in two seconds.

        # TODO 6: log the start of an outage, in which the charge is not
        #         a number, or not from 0 to 1.


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
