import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__("stats")
        self.count = 0
        self.missed = 0
        self.next = 0
        self.create_subscription(String, "chatter", self.cb, 10)

    def cb(self, msg):
        if self.count == 0:
            self.t0, self.first = time.time(), msg.data
        self.count += 1
        n = int(msg.data.split(":")[1])
        if n > self.next:
            self.missed += n - self.next
            self.get_logger().warn(f"expected {self.next} but got {n}")
        self.next = n + 1
        if self.count % 10 == 0:
            hz = self.count / (time.time() - self.t0)
            self.get_logger().info(f"received={self.count} missed={self.missed} hz={hz:.2f} first={self.first} last={msg.data}")


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
