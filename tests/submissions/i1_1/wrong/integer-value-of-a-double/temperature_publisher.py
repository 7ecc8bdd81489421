import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64
import random


class SensorNode(Node):
    def __init__(self):
        super().__init__('sensor_node')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'temp_sensor_1')
        rate = self.get_parameter('publish_rate').get_parameter_value().integer_value
        self.sensor = self.get_parameter('sensor_name').get_parameter_value().string_value
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / rate, self.publish_temperature)

    def publish_temperature(self):
        msg = Float64()
        msg.data = random.uniform(20.0, 30.0)
        self.publisher.publish(msg)
        self.get_logger().info(f'{self.sensor}: {msg.data:.2f} C')


def main():
    rclpy.init()
    node = SensorNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
