from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    remappings = [('/chatter', LaunchConfiguration('topic'))]
    namespace = LaunchConfiguration('namespace')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='demo_nodes_cpp', executable='talker', namespace=namespace, remappings=remappings),
        Node(package='demo_nodes_cpp', executable='listener', namespace=namespace, remappings=remappings),
    ])
