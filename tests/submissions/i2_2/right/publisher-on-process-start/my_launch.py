#!/usr/bin/env python3
from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument, EmitEvent, LogInfo, RegisterEventHandler, TimerAction)
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    common = {
        'package': 'demo_nodes_cpp',
        'namespace': LaunchConfiguration('namespace'),
        'remappings': [('chatter', LaunchConfiguration('topic'))],
        'output': 'screen',
    }
    subscriber = Node(executable='listener', **common)
    publisher = Node(executable='talker', **common)

    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        RegisterEventHandler(OnProcessStart(
            target_action=subscriber,
            on_start=[
                LogInfo(msg='The subscriber is up, the publisher follows'),
                TimerAction(period=0.5, actions=[publisher]),
            ])),
        RegisterEventHandler(OnProcessExit(
            target_action=publisher,
            on_exit=[EmitEvent(event=Shutdown(reason='publisher has ended'))])),
        subscriber,
    ])
