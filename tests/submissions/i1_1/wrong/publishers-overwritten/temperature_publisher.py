import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class Sensor(Node):
    def __init__(self):
        super().__init__('sensor')
        self.declare_parameters('', [('rate', 1.0), ('sensor_name', 'lab')])
        self.publishers = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1 / self.get_parameter('rate').value, self.tick)

    def tick(self):
        m = Float64(data=random.triangular(20.0, 30.0))
        self.publishers.publish(m)
        self.get_logger().info(self.get_parameter('sensor_name').value + ': ' + str(m.data))


def main():
    rclpy.init()
    try:
        rclpy.spin(Sensor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


main()
