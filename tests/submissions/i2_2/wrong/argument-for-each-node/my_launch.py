#!/usr/bin/env python3

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    # --- argomenti -----------------------------------------------------
    declared = [
        DeclareLaunchArgument('pub_topic', default_value='chatter',
                              description='topic su cui pubblica il talker'),
        DeclareLaunchArgument('sub_topic', default_value='chatter',
                              description='topic ascoltato dal listener'),
        DeclareLaunchArgument('namespace', default_value='',
                              description='namespace dei due nodi'),
    ]

    ns = LaunchConfiguration('namespace')

    # --- nodi ----------------------------------------------------------
    pub = Node(
        package='demo_nodes_py',
        executable='talker',
        name='minimal_publisher',
        namespace=ns,
        remappings=[('chatter', LaunchConfiguration('pub_topic'))],
        output='screen',
    )
    sub = Node(
        package='demo_nodes_py',
        executable='listener',
        name='minimal_subscriber',
        namespace=ns,
        remappings=[('chatter', LaunchConfiguration('sub_topic'))],
        output='screen',
    )

    return LaunchDescription(declared + [pub, sub])
