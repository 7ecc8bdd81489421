import random

import rclpy
import rclpy.logging
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


LOG = rclpy.logging.get_logger('sensor')


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        rate = self.declare_parameter('publish_rate', 1.0).value
        self.sensor = self.declare_parameter('sensor_name', 'elsewhere').value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / rate, self.tick)

    def tick(self):
        t = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=t))
        LOG.info(f'{self.sensor}: {t:.2f}')


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
