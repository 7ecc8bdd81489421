from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='speaker', namespace=LaunchConfiguration('namespace'),
             remappings=[('chatter', LaunchConfiguration('topic'))], output='screen'),
        Node(package='my_package', executable='minimal_subscriber', namespace=LaunchConfiguration('namespace'),
             remappings=[('chatter', LaunchConfiguration('topic'))], output='screen'),
    ])
