import csv
import io
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


def row(*fields):
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator='').writerow(fields)
    return buffer.getvalue()


class CsvStats(Node):
    def __init__(self):
        super().__init__('csv_stats')
        self.total = 0
        self.lost = 0
        self.seq = None
        self.get_logger().info('total,per_second,lost,first,last')
        self.create_subscription(String, '/chatter', self.add, 10)

    def add(self, msg):
        now = time.monotonic()
        if not self.total:
            self.begin, self.first = now, msg.data
        self.total += 1
        seq = int(msg.data.split()[-1])
        if self.seq is not None and seq > self.seq + 1:
            self.lost += seq - self.seq - 1
        self.seq = seq
        if self.total % 10 == 0:
            per_second = round(self.total / (now - self.begin), 2)
            self.get_logger().info(row(self.total, per_second, self.lost, self.first, msg.data))


def main():
    rclpy.init()
    node = CsvStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
