import re
import time

import rclpy
from rclpy.node import Node
from std_msgs.msg import String

number_at_end = re.compile(r'\d+$')


class StatsSubscriber(Node):

    def __init__(self):
        super().__init__('message_stats')
        self.subscription = self.create_subscription(
            String,
            '/chatter',
            self.listener_callback,
            10)

        self.call_count = 0
        self.first_time = None
        self.first_data = None
        self.last_number = None

    @staticmethod
    def get_number(text):
        match = number_at_end.search(text)
        return int(match.group()) if match else None

    @staticmethod
    def listener_callback(self, msg):
        self.call_count += 1
        if self.first_time is None:
            self.first_time = time.time()
            self.first_data = msg.data

        number = self.get_number(msg.data)
        if self.last_number is not None and number is not None:
            if number < self.last_number:
                self.get_logger().info('Publisher restarted')
            elif number > self.last_number + 1:
                self.get_logger().warning('Gap between %d and %d' % (self.last_number, number))
        self.last_number = number

        if self.call_count % 10 == 0:
            rate = self.call_count / (time.time() - self.first_time)
            self.get_logger().info(
                'Received %d messages (%.2f per second), first: %s, last: %s'
                % (self.call_count, rate, self.first_data, msg.data))


def main(args=None):
    rclpy.init(args=args)

    stats_subscriber = StatsSubscriber()

    rclpy.spin(stats_subscriber)

    # Destroy the node explicitly
    # (optional - otherwise it will be done automatically
    # when the garbage collector destroys the node object)
    stats_subscriber.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
