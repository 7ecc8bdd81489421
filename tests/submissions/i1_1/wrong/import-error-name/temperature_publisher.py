import random
import rclpy
from rclpy.node import Node
from std_msgs.msg import float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.pub = self.create_publisher(float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0, self.cb)

    def cb(self):
        self.pub.publish(float64(data=random.uniform(20.0, 30.0)))


rclpy.init()
rclpy.spin(TemperaturePublisher())
