from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    publisher = Node(package='my_package', executable='minimal_publisher')
    subscriber = Node(package='my_package', executable='minimal_subscriber')
    return LaunchDescription()
