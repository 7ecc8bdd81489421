import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Temperature


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'x')
        self.declare_parameter('publish_rate', 2.0)
        self.pub = self.create_publisher(Temperature, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.cb)

    def cb(self):
        msg = Temperature()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.temperature = random.uniform(20.0, 30.0)
        self.pub.publish(msg)
        self.get_logger().info(self.get_parameter('sensor_name').value)


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
