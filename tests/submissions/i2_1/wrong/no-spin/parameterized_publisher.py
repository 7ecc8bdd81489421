import time
import rclpy
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('parameterized_publisher')
    node.declare_parameter('message_prefix', 'Hello')
    node.declare_parameter('publish_rate', 1.0)
    node.declare_parameter('enabled', True)
    if node.get_parameter('publish_rate').value <= 0:
        node.get_logger().fatal('publish_rate must be positive')
        raise SystemExit(1)
    pub = node.create_publisher(String, 'chatter', 10)
    try:
        while rclpy.ok():
            if node.get_parameter('enabled').value:
                pub.publish(String(data=node.get_parameter('message_prefix').value))
            time.sleep(1.0 / node.get_parameter('publish_rate').value)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
