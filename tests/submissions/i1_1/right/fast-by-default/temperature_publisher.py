import random
import signal
import sys

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import Float64


class Fast(Node):
    def __init__(self):
        super().__init__('fast')
        self.sensor = self.declare_parameter('sensor_name', 'fast').value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 100)
        self.create_timer(1.0 / self.declare_parameter('publish_rate', 100.0).value, self.tick)
        self.get_logger().info(f'{self.sensor} is running')

    def tick(self):
        self.pub.publish(Float64(data=random.triangular(20.0, 30.0, 25.0)))


def stop(signum, frame):
    sys.exit(0)


rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
signal.signal(signal.SIGINT, stop)
node = Fast()
try:
    rclpy.spin(node)
finally:
    node.destroy_node()
    rclpy.shutdown()
