import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

STATUS_PERIOD = 8.0


class Thermometer(Node):
    def __init__(self):
        super().__init__('thermometer')
        self.declare_parameter('sensor_name', 'roof')
        self.declare_parameter('publish_rate', 2.0)
        self.pub = self.create_publisher(Float64, 'sensor/temperature', 10)
        self.publish_timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.publish)
        self.status_timer = self.create_timer(STATUS_PERIOD, self.report)
        self.last = 25.0

    def publish(self):
        self.last = round(random.triangular(20.0, 30.0), 2)
        self.pub.publish(Float64(data=self.last))

    def report(self):
        name = self.get_parameter('sensor_name').value
        self.get_logger().info('%s is alive, last reading %.2f' % (name, self.last))


def main(args=None):
    rclpy.init(args=args)
    thermometer = Thermometer()
    try:
        rclpy.spin(thermometer)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        thermometer.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
