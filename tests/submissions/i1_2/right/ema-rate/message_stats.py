import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__("ema_stats")
        self.count, self.at, self.period, self.seq = 0, None, None, None
        self.create_subscription(String, "chatter", self.cb, 1)

    def cb(self, msg):
        now = time.monotonic()
        if self.at is not None:
            dt = now - self.at
            self.period = dt if self.period is None else 0.8 * self.period + 0.2 * dt
        else:
            self.first = msg.data
        self.at = now
        self.count += 1
        seq = int(msg.data.split(": ")[1])
        if self.seq is not None and seq != self.seq + 1:
            what = "gap" if seq > self.seq else "restart"
            self.get_logger().warn(f"{what} detected ({self.seq} -> {seq})")
        self.seq = seq
        if self.count % 10 == 0:
            self.get_logger().warn(f"SUMMARY: {self.count} msgs; ~{1 / self.period:.1f} Hz (every {self.period * 1000:.0f} ms); first {self.first}; latest {msg.data}")


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
