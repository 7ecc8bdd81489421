import rclpy
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('abrupt')
    node.create_subscription(String, 'chatter', lambda m: node.get_logger().info('heard ' + m.data), 10)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.shutdown()
