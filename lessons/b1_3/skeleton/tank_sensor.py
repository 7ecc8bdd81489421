#!/usr/bin/env python3
"""Exercise B1.3: a sensor that publishes a type of its own."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

# TODO 5: import Reading from my_interfaces.msg, and InRange from
#         my_interfaces.srv. Define them first.


class TankSensor(Node):
    """A tank whose level rises and falls."""

    def __init__(self) -> None:
        super().__init__("tank_sensor")
        # TODO 6: create a publisher of Reading on /tank/reading, and a
        #         timer that publishes several times a second.

        # TODO 7: create the service /tank/in_range, of type InRange.

    def publish_reading(self) -> None:
        """Publish the level, and when it was measured."""
        # TODO 8: fill in all four fields of a Reading, and publish it.

    # TODO 9: write the callback of the service.


def main() -> None:
    """Run the node until Ctrl+C. This part is complete."""
    rclpy.init()
    node = TankSensor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
