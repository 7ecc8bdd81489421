import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    """Publishes the mean of the last three measurements."""

    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', 2.0)
        self.declare_parameter('sensor_name', 'greenhouse')
        self.name = self.get_parameter('sensor_name').value
        self.measured = []
        self.mean = Float64(data=0.0)
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        period = 1.0 / self.get_parameter('publish_rate').value
        self.create_timer(period, self.publish)
        self.create_timer(period, self.measure)

    def measure(self):
        self.measured.append(random.uniform(20.0, 30.0))
        if len(self.measured) == 3:
            self.mean = Float64(data=sum(self.measured) / 3)
            self.measured.pop(0)

    def publish(self):
        self.publisher.publish(self.mean)
        self.get_logger().info(f'{self.name}: {self.mean.data:.2f}')


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
