import random
import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'x')
        self.declare_parameter('publish_rate', 1.0)
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.get_logger().info('I am ' + self.get_parameter('sensor_name').value)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)

    def tick(self):
        self.publiser.publish(Float64(data=random.uniform(20.0, 30.0)))


if __name__ == '__main__':
    rclpy.init()
    rclpy.spin(TemperaturePublisher())
