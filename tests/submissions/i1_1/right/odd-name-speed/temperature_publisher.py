import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class P(Node):
    def __init__(self):
        super().__init__('p')
        self.declare_parameter('speed', 2.0)
        self.declare_parameter('who', 'me')
        self.out = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / float(self.get_parameter('speed').value), self.go)

    def go(self):
        v = min(30.0, max(20.0, random.gauss(25.0, 2.0)))
        self.out.publish(Float64(data=v))
        self.get_logger().info(self.get_parameter('who').value + ' ' + str(v))


rclpy.init()
try:
    rclpy.spin(P())
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
