#!/usr/bin/env python3
"""Measures a distance while it is active: a node with a lifecycle."""

import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from std_msgs.msg import Float64

MIN_RATE_HZ = 0.01
MAX_RATE_HZ = 1000.0


class DistanceSensor(LifecycleNode):
    """Publishes a distance in meters on the topic distance, at the rate that it was configured with."""

    def __init__(self) -> None:
        super().__init__("distance_sensor")
        self.declare_parameter("rate", 5.0)
        self.publisher = None
        self.timer = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make what the node needs, or fail, which leaves the node unconfigured."""
        rate = self.get_parameter("rate").value
        if not MIN_RATE_HZ <= rate <= MAX_RATE_HZ:  # Written this way so that nan is refused, too.
            self.get_logger().error(f"rate must be from {MIN_RATE_HZ} to {MAX_RATE_HZ} Hz, not {rate}")
            return TransitionCallbackReturn.FAILURE
        self.publisher = self.create_lifecycle_publisher(Float64, "distance", 10)
        self.timer = self.create_timer(1.0 / rate, self.measure, autostart=False)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start measuring."""
        self.timer.reset()
        return super().on_activate(state)  # This switches the lifecycle publisher on.

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop measuring, but keep what the node needs for it."""
        self.timer.cancel()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo what on_configure has done."""
        self.release()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let go of everything, from whichever state the node comes."""
        self.release()
        return TransitionCallbackReturn.SUCCESS

    def release(self) -> None:
        """Destroy timer and publisher, if there are any. Setting them to None would not do: the node keeps them."""
        if self.timer is not None:
            self.destroy_timer(self.timer)
            self.timer = None
        if self.publisher is not None:
            self.destroy_lifecycle_publisher(self.publisher)
            self.publisher = None

    def measure(self) -> None:
        """Publish one distance."""
        self.publisher.publish(Float64(data=random.uniform(0.2, 4.0)))


def main() -> None:
    """Run the node until Ctrl+C. Its transitions are for others to ask for."""
    rclpy.init()
    try:
        rclpy.spin(DistanceSensor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
