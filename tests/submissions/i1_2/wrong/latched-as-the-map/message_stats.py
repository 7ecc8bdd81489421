import rclpy
from rclpy.node import Node
from std_msgs.msg import String
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor

from rclpy.qos import QoSProfile, QoSReliabilityPolicy, QoSDurabilityPolicy, QoSHistoryPolicy


class StatisticsNode(Node):
    def __init__(self):
        super().__init__('statistics_node')

        # same profile as in the map subscriber, so that we also get the
        # messages that were published before we came up
        qos_profile = QoSProfile(
            reliability=QoSReliabilityPolicy.RELIABLE, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
            history=QoSHistoryPolicy.KEEP_LAST, depth=10)

        self.exclusive_group = MutuallyExclusiveCallbackGroup()

        self.total = 0
        self.first = None
        self.start = None
        self.last_number = None

        self.sub = self.create_subscription(
            String, 'chatter', self.sub_callback, qos_profile, callback_group=self.exclusive_group)
        self.get_logger().info('statistics_node has been started')

    def sub_callback(self, msg):
        now = self.get_clock().now()
        if self.total == 0:
            self.first = msg.data
            self.start = now
        self.total += 1

        number = int(msg.data.split(':')[-1])
        if self.last_number is not None:
            if number < self.last_number:
                self.get_logger().info('Publisher restarted')
            elif number - self.last_number > 1:
                self.get_logger().warn(f'Gap: {self.last_number} -> {number}')
        self.last_number = number

        if self.total % 10 == 0:
            dt = (now - self.start).nanoseconds / 1e9
            self.get_logger().info(
                f'total: {self.total}, rate: {self.total / dt:.2f} Hz, first: "{self.first}", last: "{msg.data}"')


def main(args=None):
    rclpy.init(args=args)
    node = StatisticsNode()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
