"""Two demo nodes in an isolated group."""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic', default='chatter')
    namespace = LaunchConfiguration('namespace', default='')

    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        GroupAction(
            forwarding=False,       # keep the configurations of others out
            launch_configurations={'topic': topic},
            actions=[
                Node(
                    package='demo_nodes_cpp', executable='talker',
                    namespace=namespace, remappings=[('chatter', topic)]),
                Node(
                    package='demo_nodes_cpp', executable='listener',
                    namespace=namespace, remappings=[('chatter', topic)]),
            ],
        ),
    ])
