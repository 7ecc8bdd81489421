import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node('reader')
node.create_subscription(String, 'news', lambda msg: node.get_logger().info(f'I heard: [{msg.data}]'), 10)
executor = EventsExecutor()
executor.add_node(node)
try:
    executor.spin()
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
