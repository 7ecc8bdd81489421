import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('loner')
    pub = node.create_publisher(String, 'chatter', 10)
    node.create_subscription(String, 'chatter', lambda m: node.get_logger().info('I heard: ' + m.data), 10)
    node.create_timer(0.5, lambda: pub.publish(String(data='hello me')))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
