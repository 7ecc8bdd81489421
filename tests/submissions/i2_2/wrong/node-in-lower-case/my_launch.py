from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic')
    ns = LaunchConfiguration('namespace')

    talker = node(
        package='my_package',
        executable='minimal_publisher',
        namespace=ns,
        remappings=[('topic', topic)],
    )
    listener = node(
        package='my_package',
        executable='minimal_subscriber',
        namespace=ns,
        remappings=[('topic', topic)],
    )
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        talker,
        listener,
    ])
