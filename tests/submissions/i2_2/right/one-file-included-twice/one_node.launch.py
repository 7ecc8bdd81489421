from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('executable', default_value='minimal_publisher'),
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('robot', default_value=''),
        Node(
            package='my_package',
            executable=LaunchConfiguration('executable'),
            namespace=LaunchConfiguration('robot'),
            remappings=[('chatter', LaunchConfiguration('topic'))],
            output='screen',
        ),
    ])
