from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    common = {'package': 'my_package', 'namespace': LaunchConfiguration('namespace'), 'output': 'screen',
              'remappings': [('chatter', LaunchConfiguration('topic'))]}
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(executable='speaker', **common),
        Node(executable='pretender', **common),
    ])
