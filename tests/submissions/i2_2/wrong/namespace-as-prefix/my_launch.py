from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    namespace = LaunchConfiguration('namespace')
    remappings = [('chatter', [namespace, LaunchConfiguration('topic')])]
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='minimal_publisher', name=[namespace, 'publisher'],
             remappings=remappings, output='screen'),
        Node(package='my_package', executable='minimal_subscriber', name=[namespace, 'subscriber'],
             remappings=remappings, output='screen'),
    ])
