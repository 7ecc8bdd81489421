import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__("stats")
        self.total_count, self.last_seq = 0, None
        self.create_subscription(String, "chatter", self.cb, 10)
        for step in range(20):
            self.get_logger().info(f"starting, step {step} of 20")
            print("." * step)
            time.sleep(0.1)

    def cb(self, msg):
        now = time.monotonic()
        if self.total_count == 0:
            self.start_time, self.first_message = now, msg.data
        self.total_count += 1
        seq = int(msg.data.split(":")[1])
        if self.last_seq is not None and seq > self.last_seq + 1:
            self.get_logger().warn(f"{seq - self.last_seq - 1} messages skipped")
        self.last_seq = seq
        if self.total_count % 10 == 0:
            rate = (self.total_count - 1) / (now - self.start_time)
            self.get_logger().info(f"count: {self.total_count}")
            self.get_logger().info(f"rate: {rate}")
            self.get_logger().info(f"first: {self.first_message}")
            self.get_logger().info(f"last: {msg.data}")


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
