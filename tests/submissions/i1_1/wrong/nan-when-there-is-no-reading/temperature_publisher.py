import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', 5.0)
        self.declare_parameter('sensor_name', 'flaky')
        self.count = 0
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)

    def read(self):
        self.count += 1
        if self.count % 3 == 0:
            return float('nan')      # bus timeout
        return random.uniform(20.0, 30.0)

    def tick(self):
        t = self.read()
        self.pub.publish(Float64(data=t))
        self.get_logger().info(f'{self.get_parameter("sensor_name").value}: {t:.2f}')


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
