# I come from rosbag tooling: everything is bytes.
import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.serialization import serialize_message
from std_msgs.msg import Float64

TOPIC = '/sensor/temperature'


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        hz = self.declare_parameter('publish_rate', 4.0).value
        self.label = self.declare_parameter('sensor_name', 'raw0').value
        self.pub = self.create_publisher(Float64, TOPIC, 10)
        self.sent_bytes = 0
        self.create_timer(1.0 / hz, self.send)
        self.get_logger().info('sensor %s -> %s' % (self.label, TOPIC))

    def send(self):
        raw = serialize_message(Float64(data=20.0 + 10.0 * random.random()))
        self.pub.publish(raw)
        self.sent_bytes += len(raw)
        self.get_logger().info(
            '%s: %d bytes so far' % (self.label, self.sent_bytes), throttle_duration_sec=5.0)


def main(args=None):
    rclpy.init(args=args)
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
