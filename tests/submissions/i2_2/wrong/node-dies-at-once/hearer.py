import rclpy
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('hearer')
    node.create_subscription(String, 'chatter', on_message, 10)
    rclpy.spin(node)
