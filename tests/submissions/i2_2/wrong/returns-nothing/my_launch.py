from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    description = LaunchDescription()
    description.add_action(DeclareLaunchArgument('topic', default_value='chatter'))
    for program in ('minimal_publisher', 'minimal_subscriber'):
        description.add_action(Node(package='my_package', executable=program,
                                    remappings=[('chatter', LaunchConfiguration('topic'))]))
