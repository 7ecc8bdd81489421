from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch():
    return LaunchDescription([
        Node(package='my_package', executable='minimal_publisher'),
        Node(package='my_package', executable='minimal_subscriber'),
    ])
