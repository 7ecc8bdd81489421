#!/usr/bin/env python3
"""Managed node that walks itself to ACTIVE, so that no launch file is needed."""
import random
from typing import Optional

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.timer import Timer
from std_msgs.msg import Float64


class TemperaturePublisher(LifecycleNode):

    def __init__(self) -> None:
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'lifecycle_probe')
        self.declare_parameter('publish_rate', 2.0)
        self._pub = None
        self._timer: Optional[Timer] = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._pub = self.create_lifecycle_publisher(Float64, '/sensor/temperature', 10)
        name = self.get_parameter('sensor_name').get_parameter_value().string_value
        self.get_logger().info(f'[{name}] configured')
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        rate = self.get_parameter('publish_rate').get_parameter_value().double_value
        self._timer = self.create_timer(1.0 / rate, self._on_timer)
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        if self._timer is not None:
            self.destroy_timer(self._timer)
            self._timer = None
        return super().on_deactivate(state)

    def _on_timer(self) -> None:
        self._pub.publish(Float64(data=random.uniform(20.0, 30.0)))


def main() -> None:
    rclpy.init()
    node = TemperaturePublisher()
    node.trigger_configure()
    node.trigger_activate()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
