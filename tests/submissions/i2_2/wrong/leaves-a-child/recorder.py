import subprocess

import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


def main():
    subprocess.Popen(['sleep', '98765'], start_new_session=True)
    rclpy.init()
    node = rclpy.create_node('recorder')
    node.create_subscription(String, 'chatter', lambda m: node.get_logger().info('recorded ' + m.data), 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
