import random
import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'sensor_1')
        self.declare_parameter('publish_rate', 1.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        for _ in range(5):
            self.tick()
            time.sleep(0.1)

    def tick(self):
        value = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=value))
        self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {value:.2f}")


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
