from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(
            package='my_package',
            node_executable='minimal_publisher',
            node_name='publisher',
            namespace=LaunchConfiguration('namespace'),
            remappings=[('topic', LaunchConfiguration('topic'))],
            output='screen',
        ),
        Node(
            package='my_package',
            node_executable='minimal_subscriber',
            node_name='subscriber',
            namespace=LaunchConfiguration('namespace'),
            remappings=[('topic', LaunchConfiguration('topic'))],
            output='screen',
        ),
    ])
