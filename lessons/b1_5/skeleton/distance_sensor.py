#!/usr/bin/env python3
"""Exercise B1.5: a sensor that measures only while it is active."""

import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


# TODO 1: make it a LifecycleNode, from rclpy.lifecycle.
class DistanceSensor(Node):
    """Publishes a distance in meters on the topic distance.

    So far, it does so from its first second to its last.
    """

    def __init__(self) -> None:
        super().__init__("distance_sensor")

        # TODO 2: declare the parameter rate (5.0), in Hz.

        # TODO 3: move what the node needs for measuring into
        #         on_configure(), and read the rate there. Fail if the
        #         rate cannot be used.
        self.publisher = self.create_publisher(Float64, "distance", 10)
        self.timer = self.create_timer(1.0, self.measure)

    # TODO 4: on_activate() and on_deactivate(): measure only in
    #         between.

    # TODO 5: on_cleanup() and on_shutdown(): undo what on_configure()
    #         has done.

    def measure(self) -> None:
        """Publish one distance. The timer calls this."""
        self.publisher.publish(Float64(data=random.uniform(0.2, 4.0)))


def main() -> None:
    """Run the node until Ctrl+C. This part is complete."""
    rclpy.init()
    node = DistanceSensor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
