import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String


class Source(Node):
    def __init__(self):
        super().__init__('source')
        self.unit = self.declare_parameter('unit', 'K').value
        period = self.declare_parameter('period', 1.0).value
        self.value = 20
        self.pub = self.create_publisher(String, '~/out', 10)
        self.create_timer(period, self.tick)

    def tick(self):
        self.pub.publish(String(data=f'{self.value} {self.unit}'))
        self.value += 1


class Sink(Node):
    def __init__(self):
        super().__init__('sink')
        self.create_subscription(String, '~/in', self.got, 10)

    def got(self, msg):
        self.get_logger().info(f'telemetry: {msg.data}')


def main():
    role = remove_ros_args(sys.argv)[1]
    rclpy.init()
    node = {'source': Source, 'sink': Sink}[role]()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
