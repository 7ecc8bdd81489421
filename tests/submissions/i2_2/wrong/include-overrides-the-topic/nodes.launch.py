from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    actions = [
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
    ]
    for executable in ('minimal_publisher', 'minimal_subscriber'):
        actions.append(Node(
            package='my_package',
            executable=executable,
            namespace=LaunchConfiguration('namespace'),
            remappings=[('chatter', LaunchConfiguration('topic'))],
            output='screen',
        ))
    return LaunchDescription(actions)
