import time

import rclpy
from builtin_interfaces.msg import Time
from my_interfaces.msg import Reading
from my_interfaces.srv import InRange
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile


class TankSensor(Node):
    def __init__(self):
        super().__init__("tank_sensor", namespace="tank")
        group = ReentrantCallbackGroup()
        qos = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pub = self.create_publisher(Reading, "reading", qos)
        self.create_timer(0.2, self.publish, callback_group=group)
        self.create_service(InRange, "in_range", self.check, callback_group=group)

    def publish(self):
        now = time.time_ns()
        reading = Reading(value=42.0, unit="percent")
        reading.header.stamp = Time(sec=now // 10**9, nanosec=now % 10**9)
        reading.sensor = self.get_name()
        self.pub.publish(reading)

    def check(self, request, response):
        return InRange.Response(inside=bool(request.low <= request.value and request.value <= request.high))


def main():
    rclpy.init()
    node = TankSensor()
    executor = MultiThreadedExecutor(2)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
