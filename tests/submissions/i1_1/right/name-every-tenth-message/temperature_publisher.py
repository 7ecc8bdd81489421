import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.name = self.declare_parameter('sensor_name', 'cellar').value
        rate = self.declare_parameter('publish_rate', 1.0).value
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / rate, self.publish_temperature)
        self.sent = 0

    def publish_temperature(self):
        message = Float64()
        message.data = random.uniform(20.0, 30.0)
        self.publisher.publish(message)
        self.sent += 1
        if self.sent % 10 == 0:
            self.get_logger().info(f'{self.name}: {self.sent} messages, the last one {message.data:.1f}')


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
