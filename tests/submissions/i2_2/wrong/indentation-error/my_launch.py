from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')
    talker = Node(package='my_package', executable='minimal_publisher', namespace=namespace,
                  remappings=[('chatter', topic)], output='screen')
      listener = Node(package='my_package', executable='minimal_subscriber', namespace=namespace,
                    remappings=[('chatter', topic)], output='screen')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        talker,
        listener,
    ])
