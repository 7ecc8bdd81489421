from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace


def generate_launch_description():
    remappings = [('chatter', LaunchConfiguration('topic'))]
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='demo_nodes_py', executable='talker', remappings=remappings, output='screen'),
        Node(package='demo_nodes_py', executable='listener', remappings=remappings, output='screen'),
        PushRosNamespace(LaunchConfiguration('namespace')),
    ])
