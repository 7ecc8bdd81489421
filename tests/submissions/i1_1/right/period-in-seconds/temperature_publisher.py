from random import uniform

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class Thermometer(Node):

    def __init__(self):
        super().__init__('thermometer')
        self.declare_parameter('sensor_label', 'outdoor')
        self.declare_parameter('period_s', 0.5)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(self.get_parameter('period_s').value, self.measure)
        self.get_logger().info('sensor: ' + self.get_parameter('sensor_label').value)

    def measure(self):
        self.pub.publish(Float64(data=uniform(20, 30)))


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Thermometer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
