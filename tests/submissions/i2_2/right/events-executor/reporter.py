import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node('reporter')
news = node.create_publisher(String, 'news', 10)
node.create_timer(0.5, lambda: news.publish(String(data='nothing new')))
executor = EventsExecutor()
executor.add_node(node)
try:
    executor.spin()
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
