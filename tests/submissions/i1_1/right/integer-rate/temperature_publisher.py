import random
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64

class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'lab')
        self.declare_parameter('publish_rate', 1)   # Hz
        self.publisher_ = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1 / self.get_parameter('publish_rate').value, self.timer_callback)

    def timer_callback(self):
        msg = Float64()
        # whole degrees are precise enough for me
        msg.data = float(random.randint(20, 30))
        self.publisher_.publish(msg)
        self.get_logger().info('%s: %.1f' % (self.get_parameter('sensor_name').value, msg.data))

def main():
    rclpy.init()
    n = TemperaturePublisher()
    try:
        rclpy.spin(n)
    except (KeyboardInterrupt, ExternalShutdownException):
        n.destroy_node()
        rclpy.try_shutdown()

main()
