import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'x')
        self.declare_parameter('publish_rate', 2.0)
        self.msg = Float64()
        self.msg.data = random.uniform(20.0, 30.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.cb)

    def cb(self):
        self.pub.publish(self.msg)
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
