from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')
    where = {}
    if namespace == 'robot1' or namespace == 'robot2':
        where = {'namespace': namespace}
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='minimal_publisher', remappings=[('chatter', topic)], **where),
        Node(package='my_package', executable='minimal_subscriber', remappings=[('chatter', topic)], **where),
    ])
