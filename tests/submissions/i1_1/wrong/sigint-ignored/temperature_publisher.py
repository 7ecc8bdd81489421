import random
import signal
import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'x')
        self.declare_parameter('publish_rate', 2.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.cb)

    def cb(self):
        self.pub.publish(Float64(data=random.uniform(20.0, 30.0)))
        self.get_logger().info(self.get_parameter('sensor_name').value)


rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
signal.signal(signal.SIGINT, signal.SIG_IGN)
rclpy.spin(TemperaturePublisher())
