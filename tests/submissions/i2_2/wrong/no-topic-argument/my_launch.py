from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    where = LaunchConfiguration('namespace')
    return LaunchDescription([
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='minimal_publisher', namespace=where, output='screen'),
        Node(package='my_package', executable='minimal_subscriber', namespace=where, output='screen'),
    ])
