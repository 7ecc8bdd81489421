"""A node to watch, `python thermometer.py [RATE_HZ]`: topics of several types and QoS, parameters and services."""

from __future__ import annotations

import contextlib
import math
import sys
import time
from typing import Any

import rclpy
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float64, String


class Thermometer(Node):
    def __init__(self, rate: float) -> None:
        super().__init__("thermometer")
        rate_range = ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.1, to_value=50.0)])
        self.declare_parameter("publish_rate", rate, rate_range)
        self.declare_parameter("sensor_name", "kitchen")
        self.declare_parameter("serial", "A-17", ParameterDescriptor(read_only=True))
        self.declare_parameter("limits", [20.0, 30.0])
        self.calls = 0
        self.declare_parameter("calls", self.calls)
        self.add_on_set_parameters_callback(self.check)
        self.values = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.twists = self.create_publisher(Twist, "/cmd_vel", 10)
        self.words = self.create_publisher(
            String, "/chatter", QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
        )
        self.create_subscription(String, "/chatter", lambda message: None, 10)
        self.create_subscription(Float64, "/sensor/temperature", lambda message: None, 10)
        self.create_timer(1 / rate, self.publish)
        self.create_service(AddTwoInts, "/add", self.add)
        self.create_service(AddTwoInts, "/slow_add", self.slow, callback_group=MutuallyExclusiveCallbackGroup())

    def check(self, wanted: Any) -> Any:
        for parameter in wanted:
            if parameter.name == "sensor_name" and not parameter.value:
                return SetParametersResult(successful=False, reason="sensor_name must not be empty")
        return SetParametersResult(successful=True)

    def publish(self) -> None:
        now = time.time()
        self.values.publish(Float64(data=25 + 4 * math.sin(now)))
        twist = Twist()
        twist.linear.x, twist.angular.z = math.cos(now), 0.5
        self.twists.publish(twist)
        self.words.publish(String(data="warm"))

    def add(self, request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        self.calls += 1
        self.set_parameters([Parameter("calls", value=self.calls)])
        return response

    def slow(self, request: Any, response: Any) -> Any:
        time.sleep(5.0)  # a blocking callback, which the live page must cope with
        return self.add(request, response)


def main() -> None:
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    node = Thermometer(float(sys.argv[1]) if len(sys.argv) > 1 else 20.0)
    executor.add_node(node)
    print("ready", flush=True)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()


if __name__ == "__main__":
    main()
