#!/usr/bin/env python3
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic_arg = DeclareLaunchArgument('topic', default_value='chatter', description='Topic to talk on')
    ns_arg = DeclareLaunchArgument('namespace', default_value='', description='Namespace of the nodes')

    publisher = Node(
        package='demo_nodes_cpp',
        executable='talker',
        name='publisher',
        namespace=LaunchConfiguration('namespace'),
        remappings=[('chatter', LaunchConfiguration('topic'))],
        output='screen',
    )

    subscriber = Node(
        package='demo_nodes_cpp',
        executable='listener',
        name='subscriber',
        namespace=LaunchConfiguration('namespace'),
        remappings=[('chatter', LaunchConfiguration('topic'))],
        output='screen',
    )

    return LaunchDescription([topic_arg, ns_arg, publisher, subscriber])
