import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64


def main():
    rclpy.init()
    node = rclpy.create_node('number_hearer')
    node.create_subscription(Float64, 'chatter', lambda m: node.get_logger().info(str(m.data)), 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
