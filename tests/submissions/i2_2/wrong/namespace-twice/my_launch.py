from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace


def generate_launch_description():
    ns = LaunchConfiguration('namespace')
    rules = [('chatter', LaunchConfiguration('topic'))]
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        GroupAction([
            PushRosNamespace(ns),
            Node(package='my_package', executable='minimal_publisher', namespace=ns, remappings=rules),
            Node(package='my_package', executable='minimal_subscriber', namespace=ns, remappings=rules),
        ]),
    ])
