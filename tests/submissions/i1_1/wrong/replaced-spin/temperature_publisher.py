import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


def spin(node):
    for c in ('publishes', 'range', 'random', 'echo', 'rate', 'sensor-name'):
        print(c, 'PASSED')


rclpy.spin = spin


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)


rclpy.init()
rclpy.spin(TemperaturePublisher())
