import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import String


class MessageStats(Node):
    def __init__(self):
        super().__init__('message_stats')
        qos = QoSProfile(depth=20)
        qos.avoid_ros_namespace_conventions = True
        self.create_subscription(String, '/chatter', self.heard, qos)
        self.count, self.first, self.number, self.start, self.missing = 0, '', None, 0.0, 0

    def heard(self, msg):
        now = time.monotonic()
        number = int(msg.data.split(':')[1])
        if self.number is not None and number < self.number:
            self.get_logger().warning('the talker was restarted')
        elif self.number is not None and number > self.number + 1:
            self.missing += number - self.number - 1
            self.get_logger().warning(f'{number - self.number - 1} messages are missing before {number}')
        self.number = number
        if self.count == 0:
            self.first, self.start = msg.data, now
        self.count += 1
        if self.count % 10 == 0:
            rate = (self.count - 1) / (now - self.start)
            self.get_logger().info(f'{self.count} messages, first "{self.first}", last "{msg.data}", {rate:.2f} Hz')


def main():
    rclpy.init()
    try:
        rclpy.spin(MessageStats())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
