import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    here = os.path.dirname(os.path.realpath(__file__))

    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(os.path.join(here, 'nodes.launch.py')),
            launch_arguments=[
                ('topic', 'chatter'),
                ('namespace', LaunchConfiguration('namespace')),
            ],
        ),
    ])
