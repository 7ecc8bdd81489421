import rclpy
from rclpy.node import Node
from rclpy.qos import *
from rclpy.duration import Duration
from std_msgs.msg import String
rclpy.init()
n = Node('sub')
def got(m):
    n.get_logger().info('got ' + m.data)
n.create_subscription(String, 'chatter', got, QoSProfile(depth=10, deadline=Duration(seconds=1)))

try:
    rclpy.spin(n)
except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
    pass
rclpy.try_shutdown()
