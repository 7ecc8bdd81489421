import time

import rclpy
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('sleeper')
    node.create_subscription(String, 'chatter', lambda m: node.get_logger().info(m.data), 10)
    try:
        while rclpy.ok():
            time.sleep(0.1)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()
