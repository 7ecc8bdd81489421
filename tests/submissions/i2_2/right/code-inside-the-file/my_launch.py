"""Everything in one file: the two nodes are handed to `python -c`."""
import sys

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration

HEAD = '''
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String
rclpy.init()
'''
PUBLISHER = HEAD + '''
import itertools
node = rclpy.create_node('one')
pub = node.create_publisher(String, 'line', 10)
numbers = itertools.count()
node.create_timer(0.3, lambda: pub.publish(String(data='ring ' + str(next(numbers)))))
'''
SUBSCRIBER = HEAD + '''
node = rclpy.create_node('two')
sub = node.create_subscription(String, 'line', lambda m: node.get_logger().info(m.data), 10)
'''
TAIL = '''
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
node.destroy_node()
rclpy.try_shutdown()
'''


def run(code):
    return ExecuteProcess(
        cmd=[sys.executable, '-u', '-c', code + TAIL, '--ros-args',
             '-r', ['line:=', LaunchConfiguration('topic')],
             '-r', ['__ns:=/', LaunchConfiguration('namespace')]],
        output='screen')


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='telephone'),
        DeclareLaunchArgument('namespace', default_value=''),
        run(PUBLISHER),
        run(SUBSCRIBER),
    ])
