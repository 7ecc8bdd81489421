import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class SlowStats(Node):
    def __init__(self):
        super().__init__("slow_stats")
        self.get_logger().info("loading a big model ...")
        time.sleep(2.0)
        self.total = 0
        self.missed = 0
        self.begin = None
        self.number = None
        self.create_subscription(String, "chatter", self.take, 10)
        self.get_logger().info("ready")

    def take(self, msg):
        self.total += 1
        if self.begin is None:
            self.begin = time.time()
            self.first = msg.data
        number = int(msg.data.split(":")[1])
        if self.number is not None and number > self.number + 1:
            self.missed += number - self.number - 1
        self.number = number
        if self.total % 10 == 0:
            loss = 100.0 * self.missed / (self.missed + self.total)
            self.get_logger().info(f"n={self.total} f={self.total / (time.time() - self.begin):.2f} Hz loss={loss:.1f}% first=<{self.first}> last=<{msg.data}>")


def main():
    rclpy.init()
    node = SlowStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
