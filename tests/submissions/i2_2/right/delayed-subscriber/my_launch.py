from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, TimerAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    settings = {
        'package': 'my_package',
        'namespace': LaunchConfiguration('namespace'),
        'remappings': [('chatter', LaunchConfiguration('topic'))],
        'output': 'screen',
    }
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(executable='minimal_publisher', **settings),
        TimerAction(period=3.0, actions=[Node(executable='minimal_subscriber', **settings)]),
    ])
