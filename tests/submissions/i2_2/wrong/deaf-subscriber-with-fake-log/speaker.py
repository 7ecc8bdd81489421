import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('speaker')
    pub = node.create_publisher(String, 'chatter', qos_profile_sensor_data)
    node.create_timer(0.5, lambda: pub.publish(String(data='Hello World')))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
