from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument('topic', default_value='chatter', choices=['chatter', 'my_topic'], description='Topic'), DeclareLaunchArgument('namespace', default_value='', description='Namespace')] + [
        Node(package='demo_nodes_py', executable='talker', namespace=LaunchConfiguration('namespace'), remappings=[('chatter', LaunchConfiguration('topic'))], output='screen'),
        Node(package='demo_nodes_py', executable='listener', namespace=LaunchConfiguration('namespace'), remappings=[('chatter', LaunchConfiguration('topic'))], output='screen'),
    ])
