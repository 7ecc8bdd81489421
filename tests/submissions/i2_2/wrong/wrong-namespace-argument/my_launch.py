from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('ns', default_value=''),
        Node(package='demo_nodes_py', executable='talker', namespace=LaunchConfiguration('ns'),
             remappings=[('chatter', topic)], output='screen'),
        Node(package='demo_nodes_py', executable='listener', namespace=LaunchConfiguration('ns'),
             remappings=[('chatter', topic)], output='screen'),
    ])
