from __future__ import annotations

import math
import time
from dataclasses import dataclass

import rclpy
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import Twist
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import LaserScan


@dataclass
class Stats:
    count: int = 0
    last_t_wall: float = 0.0
    hz_ema: float = 0.0

    def tick(self) -> None:
        now = time.time()
        if self.last_t_wall > 0:
            dt = now - self.last_t_wall
            if dt > 0:
                hz = 1.0 / dt
                self.hz_ema = hz if self.hz_ema == 0.0 else (0.9 * self.hz_ema + 0.1 * hz)
        self.last_t_wall = now
        self.count += 1


class SmokeTestNode(Node):
    def __init__(self):
        super().__init__("concurrent_smoke_test")

        self.scan_topic = self.declare_parameter("scan_topic", "/scan").value
        self.cmd_vel_topic = self.declare_parameter("cmd_vel_topic", "/cmd_vel").value

        self._pub = self.create_publisher(Twist, self.cmd_vel_topic, 10)

        self._scan_stats = Stats()
        self._timer_stats = Stats()

        scan_qos = QoSProfile(depth=10)
        scan_qos.reliability = QoSReliabilityPolicy.RELIABLE
        self.create_subscription(LaserScan, self.scan_topic, self._on_scan, scan_qos)

        self._slow_group = MutuallyExclusiveCallbackGroup()
        self._fast_group = ReentrantCallbackGroup()
        self.create_service(
            AddTwoInts, "/slow_add", self._on_slow_add, callback_group=self._slow_group
        )

        self._t0 = time.time()
        self._phase = 0

        self.create_timer(0.1, self._publish_cmd, callback_group=self._fast_group)

        self.get_logger().info("Smoke test started.")

    def _on_scan(self, msg: LaserScan) -> None:
        self._scan_stats.tick()

    def _on_slow_add(self, request, response):
        self.get_logger().info("slow_add: working")
        time.sleep(3.0)
        response.sum = request.a + request.b
        self.get_logger().info("slow_add: finished")
        return response

    def _publish_cmd(self) -> None:
        self._timer_stats.tick()
        self.get_logger().info(f"timer tick {self._timer_stats.count}")

        # forward for a while, rotate for a while
        t = time.time() - self._t0
        self._phase = int(t // 5) % 2

        msg = Twist()
        if self._phase == 0:
            msg.linear.x = 0.2
            msg.angular.z = 0.0
        else:
            msg.linear.x = 0.0
            msg.angular.z = 0.6

        msg.angular.z += 0.1 * math.sin(t)
        self._pub.publish(msg)


def main() -> None:
    rclpy.init()
    node = SmokeTestNode()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        while rclpy.ok():
            executor.spin_once(timeout_sec=0.2)
            time.sleep(0.2)  # do not burn the CPU
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        try:
            executor.remove_node(node)
        except Exception:
            pass
        node.destroy_node()
        try:
            rclpy.shutdown()
        except Exception:
            pass


if __name__ == "__main__":
    main()
