import random
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64, String


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.sensor = self.declare_parameter('sensor_name', 'lab').value
        rate = self.declare_parameter('publish_rate', 1.0).value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / rate, lambda: self.tick())

    async def tick(self):
        value = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=value))
        self.get_logger().info(f'{self.sensor}: {value:.1f}')


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
