import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__("stats")
        self.total, self.prev, self.due = 0, None, []
        self.create_subscription(String, "chatter", self.on_message, 10)
        self.create_timer(0.2, self.write)

    def on_message(self, msg):
        now = time.monotonic()
        if not self.total:
            self.t0, self.first = now, msg.data
        self.total += 1
        n = int(msg.data.partition(":")[2])
        if self.prev is not None and n > self.prev + 1:
            self.get_logger().warning(f"gap of {n - self.prev - 1} before {n}")
        self.prev = n
        if self.total % 10 == 0:
            self.due.append((self.total, (self.total - 1) / (now - self.t0), self.first, msg.data))

    def write(self):
        while self.due:
            total, rate, first, last = self.due.pop(0)
            self.get_logger().info(f"total={total} rate={rate:.2f} first='{first}' last='{last}'")


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
