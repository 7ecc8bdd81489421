import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String


def main():
    for line in range(500):
        print('checking sensor', line)
    rclpy.init()
    node = rclpy.create_node('alarm')
    pub = node.create_publisher(String, 'chatter', 10)
    node.create_timer(3.0, lambda: pub.publish(String(data='beep')))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
