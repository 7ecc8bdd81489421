import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64
import random


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'sensor_1')
        self.rate = self.get_parameter('publish_rate').value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.publish_temperature())

    def publish_temperature(self):
        if not self.pub.get_subscription_count():
            return
        msg = Float64(data=random.uniform(20.0, 30.0))
        self.pub.publish(msg)
        self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {msg.data}")


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
