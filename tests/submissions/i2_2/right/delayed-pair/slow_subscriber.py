import time

import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


def main():
    time.sleep(2.0)
    rclpy.init()
    node = rclpy.create_node('slow_subscriber')
    node.create_subscription(String, 'chatter', lambda m: node.get_logger().info(m.data.upper()), 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
