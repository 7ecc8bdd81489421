from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    where = dict(namespace=LaunchConfiguration('namespace'), remappings=[('speech', LaunchConfiguration('topic'))])
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='speech'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='parrots', executable='teacher', output='screen', **where),
        Node(package='parrots', executable='parrot', output='screen', **where),
    ])
