import random
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64

rclpy.init()
node = rclpy.create_node('temp')
sensor = node.declare_parameter('sensor', 'T1').value
rate = node.declare_parameter('publish_rate', 4.0).value
pub = node.create_publisher(Float64, '/sensor/temperature', 1)


def tick():
    t = 20 + 10 * random.random()
    pub.publish(Float64(data=t))
    node.get_logger().info('%s says %f' % (sensor, t))


node.create_timer(1 / rate, tick)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
