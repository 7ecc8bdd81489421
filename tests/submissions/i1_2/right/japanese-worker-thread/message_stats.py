import queue
import threading
import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

WIDE = str.maketrans("0123456789.", "０１２３４５６７８９．")


class Tokei(Node):
    def __init__(self):
        super().__init__("tokei")
        self.q = queue.Queue()
        self.total = 0
        self.create_subscription(String, "chatter", lambda m: self.q.put((time.time(), m.data)), 10)
        threading.Thread(target=self.work, daemon=True).start()

    def work(self):
        prev = None
        while True:
            at, data = self.q.get()
            self.total += 1
            if self.total == 1:
                start, first = at, data
            n = int(data.split(":")[1])
            if prev is not None and n > prev + 1:
                self.get_logger().warning(f"メッセージが{n - prev - 1}件抜けています")
            if prev is not None and n < prev:
                self.get_logger().info("配信者が再起動しました")
            prev = n
            if self.total % 10 == 0:
                hz = f"{self.total / (at - start):.2f}".translate(WIDE)
                self.get_logger().info(f"合計{str(self.total).translate(WIDE)}件 毎秒{hz}件 最初「{first}」 最後「{data}」")


def main():
    rclpy.init()
    node = Tokei()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
