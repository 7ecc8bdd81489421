#!/usr/bin/env python3
import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).resolve().parent


def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')

    # no package: the executable is the interpreter, the script its argument
    source = Node(
        executable=sys.executable,
        arguments=[str(HERE / 'telemetry.py'), 'source'],
        name='source',
        namespace=namespace,
        parameters=[str(HERE / 'telemetry.yaml'), {'unit': 'degC'}],
        remappings=[('~/out', topic)],
        output='screen')
    sink = Node(
        executable=sys.executable,
        arguments=[str(HERE / 'telemetry.py'), 'sink'],
        name='sink',
        namespace=namespace,
        remappings=[('~/in', topic)],
        output='screen')

    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='telemetry'),
        DeclareLaunchArgument('namespace', default_value=''),
        source,
        sink,
    ])
