import random
import sys
import warnings

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

warnings.warn('this sensor is deprecated, buy a new one')
for i in range(500):
    print('checking register', i)
print('Traceback (most recent call last): just kidding', file=sys.stderr)


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        for i in range(300):
            self.get_logger().info(f'self test {i}')
        self.get_logger().error('battery low')
        self.get_logger().fatal('fan missing')
        self.declare_parameter('sensor_name', 'noisy')
        self.declare_parameter('publish_rate', 5.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)

    def tick(self):
        value = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=value))
        for i in range(10):
            print('=' * 200)
            self.get_logger().warn('temperature!')
        self.get_logger().info(f"{self.get_parameter('sensor_name').value} {value}")


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
