#!/usr/bin/env python3
"""Exercise I2.3: a service that takes three seconds, beside a timer.

The timer must not wait for the service.
"""

from rclpy.node import Node

# TODO 1: import rclpy, and AddTwoInts from example_interfaces.srv.


class ConcurrentService(Node):
    """Adds two numbers slowly while a 10 Hz timer ticks on."""

    def __init__(self) -> None:
        super().__init__("concurrent_service")
        self.ticks = 0
        # TODO 2: create the service slow_add, of type AddTwoInts.

        # TODO 3: create a timer of 10 Hz that calls self.tick.

        # TODO 4: put both into callback groups, so that the timer need
        #         not wait for the service.

        self.get_logger().info("Concurrent service is up")

    # TODO 5: write the service's callback. It is given a request (a and
    #         b) and an empty response: wait for three seconds, fill in
    #         response.sum, and return the response.

    def tick(self) -> None:
        """Count, and log every tenth tick. This part is complete."""
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info(f"Tick {self.ticks}")


def main() -> None:
    """Run the node until Ctrl+C."""
    # TODO 6: initialise rclpy and make the node.

    # TODO 7: run it with an executor that has several threads: make the
    #         executor, add the node to it, and let it spin.

    # TODO 8: end cleanly on Ctrl+C: without a traceback, and soon.


if __name__ == "__main__":
    main()
