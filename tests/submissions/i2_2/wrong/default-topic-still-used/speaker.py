import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('speaker')
    topics = {'chatter', node.declare_parameter('topic', 'chatter').value}
    pubs = [node.create_publisher(String, topic, 10) for topic in topics]
    node.create_timer(0.5, lambda: [pub.publish(String(data='hello')) for pub in pubs])
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
