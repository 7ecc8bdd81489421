import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Counter(Node):
    def __init__(self):
        super().__init__("counter")
        self.reset()
        self.create_subscription(String, "chatter", self.on_message, 10)

    def reset(self):
        self.total = 0
        self.first = ""
        self.last = ""
        self.started = 0.0
        self.seq = None

    def on_message(self, msg):
        seq = int(msg.data.rsplit(" ", 1)[1])
        if self.seq is not None and seq <= self.seq:
            self.get_logger().warning("publisher restarted, statistics start over")
            self.reset()
        if self.seq is not None and seq - self.seq > 1:
            self.get_logger().warning(f"lost {seq - self.seq - 1} message(s)")
        self.seq = seq
        if not self.total:
            self.first, self.started = msg.data, time.perf_counter()
        self.total += 1
        self.last = msg.data
        if not self.total % 10:
            hz = (self.total - 1) / (time.perf_counter() - self.started)
            self.get_logger().info(f"total {self.total} | {hz:.3f} Hz | first: {self.first} | last: {self.last}")


def main():
    rclpy.init()
    node = Counter()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
