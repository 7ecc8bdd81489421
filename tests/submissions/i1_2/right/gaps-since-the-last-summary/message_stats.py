import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__('stats')
        self.total = 0
        self.gaps = 0
        self.last_number = None
        self.create_subscription(String, 'chatter', self.callback, 10)

    def callback(self, msg):
        now = time.perf_counter()
        number = int(msg.data.split(': ')[1])
        if self.total == 0:
            self.first, self.begin = msg.data, now
        elif number != self.last_number + 1:
            self.gaps += 1
        self.last_number = number
        self.total += 1
        if self.total % 10 == 0:
            self.get_logger().info(
                f'total: {self.total} | {(self.total - 1) / (now - self.begin):.1f} Hz | {self.first} ... {msg.data} '
                f'| new gaps: {self.gaps}'
            )
            self.gaps = 0


def main():
    rclpy.init()
    try:
        rclpy.spin(Stats())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
