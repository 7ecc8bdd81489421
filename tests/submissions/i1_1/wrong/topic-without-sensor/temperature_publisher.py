import random
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64

rclpy.init()
node = rclpy.create_node('temperature_publisher')
node.declare_parameter('sensor_name', 'x')
node.declare_parameter('publish_rate', 1.0)
pub = node.create_publisher(Float64, 'temperature', 10)


def cb():
    pub.publish(Float64(data=random.uniform(20.0, 30.0)))
    node.get_logger().info(node.get_parameter('sensor_name').value)


timer = node.create_timer(1.0 / node.get_parameter('publish_rate').value, cb)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
