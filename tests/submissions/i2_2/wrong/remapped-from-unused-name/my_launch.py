from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    remappings = [('topic', LaunchConfiguration('topic'))]
    namespace = LaunchConfiguration('namespace')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='minimal_publisher', namespace=namespace, remappings=remappings),
        Node(package='my_package', executable='minimal_subscriber', namespace=namespace, remappings=remappings),
    ])
