import random
import time

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        name = self.declare_parameter('sensor_name', 'sensor_1').value
        rate = self.declare_parameter('publish_rate', 2.0).value
        publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        while True:
            value = random.uniform(20.0, 30.0)
            publisher.publish(Float64(data=value))
            self.get_logger().info(f'{name}: {value:.2f}')
            time.sleep(1.0 / rate)


def main():
    rclpy.init()
    try:
        rclpy.spin(TemperaturePublisher())
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
