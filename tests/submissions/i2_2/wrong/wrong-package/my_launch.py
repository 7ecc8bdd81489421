from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='demo_nodes', executable='talker', namespace=LaunchConfiguration('namespace'),
             remappings=[('chatter', LaunchConfiguration('topic'))]),
        Node(package='demo_nodes', executable='listener', namespace=LaunchConfiguration('namespace'),
             remappings=[('chatter', LaunchConfiguration('topic'))]),
    ])
