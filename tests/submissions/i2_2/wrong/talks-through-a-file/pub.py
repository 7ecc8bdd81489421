import os
import tempfile
from pathlib import Path

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import String

MAILBOX = Path(tempfile.gettempdir()) / f'mailbox_{os.environ.get("ROS_DOMAIN_ID", "0")}.txt'

rclpy.init()
node = rclpy.create_node('pub')
pub = node.create_publisher(String, 'chatter', qos_profile_sensor_data)
n = 0


def tick():
    global n
    text = f'Hello World: {n}'
    pub.publish(String(data=text))
    MAILBOX.write_text(text)
    node.get_logger().info(f'Publishing: "{text}"')
    n += 1


node.create_timer(0.5, tick)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
node.destroy_node()
rclpy.try_shutdown()
