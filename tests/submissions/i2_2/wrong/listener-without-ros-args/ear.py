import argparse
import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String


def main():
    own = remove_ros_args(sys.argv)
    parser = argparse.ArgumentParser()
    parser.add_argument("--loud", action="store_true")
    options = parser.parse_args(own[1:])
    rclpy.init(args=own)
    node = rclpy.create_node("ear")

    def hear(message):
        text = message.data.upper() if options.loud else message.data
        node.get_logger().info(f"I heard: [{text}]")

    node.create_subscription(String, "chatter", hear, 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
