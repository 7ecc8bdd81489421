#!/usr/bin/env python3
import os
import sys

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = os.path.dirname(os.path.abspath(__file__))


def generate_launch_description():
    common = {
        'namespace': LaunchConfiguration('namespace'),
        'remappings': [('chatter', LaunchConfiguration('topic'))],
        'output': 'screen',
    }
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(executable=sys.executable, arguments=[os.path.join(HERE, 'player.py')],
             name='player', sigterm_timeout='600', **common),
        Node(package='demo_nodes_cpp', executable='listener', name='listener', **common),
    ])
