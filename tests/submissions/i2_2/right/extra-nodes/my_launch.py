from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    namespace = LaunchConfiguration('namespace')
    topic = LaunchConfiguration('topic')
    common = dict(package='my_package', namespace=namespace, remappings=[('chatter', topic)], output='screen')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        LogInfo(msg=['starting on ', topic]),
        Node(executable='minimal_publisher', **common),
        Node(executable='minimal_subscriber', **common),
        Node(executable='minimal_subscriber', name='second_subscriber', **common),
        Node(package='demo_nodes_py', executable='talker', name='heartbeat', remappings=[('chatter', '/heartbeat')]),
        Node(package='demo_nodes_py', executable='listener', name='watchdog', remappings=[('chatter', '/heartbeat')]),
        Node(package='demo_nodes_py', executable='listener', name='idle', remappings=[('chatter', '/nothing')]),
    ])
