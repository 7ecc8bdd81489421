from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter', description='Le thème'),
        DeclareLaunchArgument('namespace', default_value=''),
        *[
            Node(package='my_package', executable=program, namespace=LaunchConfiguration('namespace'),
                 remappings=[('chatter', LaunchConfiguration('topic'))])
            for program in ('minimal_publisher', 'minimal_subscriber')
        ],
    ])
