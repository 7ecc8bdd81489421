import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

TOPIC = os.environ['CHAT_TOPIC']


def generate_launch_description():
    common = {
        'package': 'my_package',
        'namespace': LaunchConfiguration('namespace'),
        'remappings': [('chatter', LaunchConfiguration('topic'))],
        'output': 'screen',
    }
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value=TOPIC),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(executable='minimal_publisher', **common),
        Node(executable='minimal_subscriber', **common),
    ])
