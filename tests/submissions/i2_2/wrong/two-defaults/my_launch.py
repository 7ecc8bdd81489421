from launch import LaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    namespace = LaunchConfiguration('namespace', default='')
    return LaunchDescription([
        Node(package='my_package', executable='minimal_publisher', namespace=namespace,
             remappings=[('chatter', LaunchConfiguration('topic', default='chatter'))]),
        Node(package='my_package', executable='minimal_subscriber', namespace=namespace,
             remappings=[('chatter', LaunchConfiguration('topic', default='chater'))]),
    ])
