from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace, SetRemap


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        GroupAction([
            PushRosNamespace(LaunchConfiguration('namespace')),
            SetRemap(src='chatter', dst=LaunchConfiguration('topic')),
            Node(package='my_package', executable='minimal_publisher', output='screen'),
            Node(package='my_package', executable='minimal_subscriber', output='screen'),
        ]),
    ])
