import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__("stats")
        self.total = self.reported = 0
        self.prev = None
        self.gaps = 0
        self.create_subscription(String, "chatter", self.on_message, 10)
        self.create_timer(0.1, self.look)

    def on_message(self, msg):
        self.at = time.monotonic()
        if not self.total:
            self.t0, self.first = self.at, msg.data
        self.total += 1
        self.last = msg.data
        n = int(msg.data.partition(":")[2])
        self.gaps += self.prev is not None and n > self.prev + 1
        self.prev = n

    def look(self):
        if self.total // 10 > self.reported:
            self.reported = self.total // 10
            rate = (self.total - 1) / (self.at - self.t0)
            self.get_logger().info(f"{self.total} / {rate:.2f} / {self.gaps} / {self.first} / {self.last}")


def main():
    rclpy.init()
    node = Stats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
