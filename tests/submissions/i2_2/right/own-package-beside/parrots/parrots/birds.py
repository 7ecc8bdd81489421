import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

from parrots.words import WORDS


def run(node):
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


def teach():
    rclpy.init()
    node = Node('teacher')
    pub = node.create_publisher(String, 'speech', 10)
    node.create_timer(0.5, lambda: pub.publish(String(data=WORDS)))
    run(node)


def repeat():
    rclpy.init()
    node = Node('parrot')
    node.create_subscription(String, 'speech', lambda m: node.get_logger().info(m.data), 10)
    run(node)
