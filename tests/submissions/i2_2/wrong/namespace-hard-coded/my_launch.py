from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument('topic', default_value='chatter', description='Topic'), DeclareLaunchArgument('namespace', default_value='', description='Namespace')] + [
        Node(package='demo_nodes_py', executable='talker', namespace='my_robot', remappings=[('chatter', LaunchConfiguration('topic'))]),
        Node(package='demo_nodes_py', executable='listener', namespace='my_robot', remappings=[('chatter', LaunchConfiguration('topic'))]),
    ])
