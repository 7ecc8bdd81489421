#!/usr/bin/env python3
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String


class MessageStats(Node):

    def __init__(self):
        super().__init__(
            'message_stats',
            parameter_overrides=[Parameter('use_sim_time', Parameter.Type.BOOL, True)])
        self.count = 0
        self.first = None
        self.start = None
        self.previous = None
        self.create_subscription(String, 'chatter', self.callback, 10)

    def callback(self, msg):
        now = self.get_clock().now()
        if self.first is None:
            self.first = msg.data
            self.start = now
        self.count += 1

        n = int(msg.data.split(':')[1])
        if self.previous is not None and n - self.previous > 1:
            self.get_logger().warning(f'{n - self.previous - 1} messages lost')
        self.previous = n

        if self.count % 10 == 0:
            elapsed = (now - self.start).nanoseconds / 1e9
            rate = self.count / elapsed if elapsed > 0 else 0.0
            self.get_logger().info(
                f'Total: {self.count}, rate: {rate:.2f} msg/s, '
                f'first: "{self.first}", last: "{msg.data}"')


def main():
    rclpy.init()
    node = MessageStats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
