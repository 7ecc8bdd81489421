import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir

HERE = os.path.dirname(os.path.abspath(__file__))


def generate_launch_description():
    passed_on = {'where': LaunchConfiguration('topic'), 'robot': LaunchConfiguration('namespace')}
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter', description='where the two meet'),
        DeclareLaunchArgument('namespace', default_value=''),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(os.path.join(HERE, 'one_node.launch.py')),
            launch_arguments={**passed_on, 'program': 'minimal_publisher'}.items(),
        ),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(PathJoinSubstitution([ThisLaunchFileDir(), 'one_node.launch.py'])),
            launch_arguments={**passed_on, 'program': 'minimal_subscriber'}.items(),
        ),
    ])
