import random
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64

rclpy.init()
node = rclpy.create_node('temperature_publisher')
sensor = node.declare_parameter('sensor_name', 'x').value
hz = node.declare_parameter('publish_rate', 2.0).value
pub = node.create_publisher(Float64, '/sensor/temperature', 10)


def cb():
    pub.publish(Float64(data=random.random() * 10))
    node.get_logger().info(sensor)


node.create_timer(1.0 / hz, cb)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
