from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic, namespace = LaunchConfiguration('topic'), LaunchConfiguration('namespace')
    publisher = Node(package='demo_nodes_py', executable='talker', namespace=namespace,
                     remappings=[('chatter', topic)])
    subscriber = Node(package='demo_nodes_py', executable='listener', namespace=namespace,
                      remappings=[('chatter', topic)])
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        subscriber,
    ])
