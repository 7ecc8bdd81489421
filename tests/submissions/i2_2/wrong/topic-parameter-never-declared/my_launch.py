import os
import sys

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def launch_setup(context, *args, **kwargs):
    here = os.path.dirname(os.path.realpath(__file__))
    params = {
        'topic': LaunchConfiguration('topic').perform(context),
        'rate': 2.0,
    }
    nodes = []
    for role in ('pub', 'sub'):
        nodes.append(Node(
            executable=sys.executable,
            arguments=[os.path.join(here, 'string_' + role + '.py')],
            name='string_' + role,
            namespace=LaunchConfiguration('namespace').perform(context),
            parameters=[params],
            output='screen',
        ))
    return nodes


def generate_launch_description():

    declared_arguments = [
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
    ]

    return LaunchDescription(declared_arguments + [OpaqueFunction(function=launch_setup)])
