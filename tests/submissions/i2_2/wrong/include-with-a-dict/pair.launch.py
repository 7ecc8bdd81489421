from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    ns = LaunchConfiguration('namespace')
    remap = [('chatter', LaunchConfiguration('topic'))]

    return LaunchDescription([
        DeclareLaunchArgument('topic'),
        DeclareLaunchArgument('namespace'),
        Node(package='demo_nodes_cpp', executable='talker', namespace=ns, remappings=remap, output='screen'),
        Node(package='demo_nodes_cpp', executable='listener', namespace=ns, remappings=remap, output='screen'),
    ])
