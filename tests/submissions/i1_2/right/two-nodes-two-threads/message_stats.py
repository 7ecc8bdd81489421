import threading
import time
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String


class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(String, "chatter", self.cb, 10)

    def cb(self, msg):
        self.get_logger().info(f"I heard [{msg.data}]")


class Stats(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.lock = threading.Lock()
        self.count = 0
        self.seqs = []
        self.create_subscription(String, "chatter", self.cb, 10, callback_group=ReentrantCallbackGroup())

    def cb(self, msg):
        with self.lock:
            self.count += 1
            if self.count == 1:
                self.t0, self.first = time.time(), msg.data
            self.seqs.append(int(msg.data.split(":")[1]))
            if self.count % 10 == 0:
                gaps = sum(1 for a, b in zip(self.seqs, self.seqs[1:]) if b - a > 1)
                self.get_logger().info(
                    f"{self.count} messages, {self.count / (time.time() - self.t0):.1f} Hz, gaps: {gaps}, "
                    f"'{self.first}' to '{msg.data}'"
                )


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    nodes = [Listener(), Stats()]
    for node in nodes:
        executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        for node in nodes:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
