import time
from collections import deque
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import String


class Windowed(Node):
    def __init__(self):
        super().__init__("windowed_stats")
        self.count = 0
        self.first = None
        self.times = deque()
        self.prev = None
        self.create_subscription(String, "chatter", self.heard, qos_profile_sensor_data)

    def heard(self, msg):
        now = time.time()
        self.times.append(now)
        while now - self.times[0] > 1.0:
            self.times.popleft()
        self.count += 1
        if self.first is None:
            self.first = msg.data
        n = int(msg.data.split()[-1])
        if self.prev is not None and n - self.prev > 1:
            self.get_logger().error(f"GAP! {self.prev} -> {n}")
        self.prev = n
        if self.count % 10 == 0:
            self.get_logger().info(
                "\n".join([
                    "",
                    "+----------------+",
                    f"| messages | {self.count:5d} |",
                    f"| last second | {len(self.times):2d} msg/s |",
                    f"| first | {self.first:20s} |",
                    f"| last  | {msg.data:20s} |",
                    "+----------------+",
                ])
            )


def main(args=None):
    rclpy.init(args=args)
    node = Windowed()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
