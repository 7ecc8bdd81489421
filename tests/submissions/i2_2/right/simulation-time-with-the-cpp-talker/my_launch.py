"""Bring up the demo pair. Runs on simulation time by default, as the rest of our stack does."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    use_sim_time = LaunchConfiguration('use_sim_time', default='true')
    topic = LaunchConfiguration('topic', default='chatter')
    namespace = LaunchConfiguration('namespace', default='')

    common = {
        'package': 'demo_nodes_cpp',
        'namespace': namespace,
        'parameters': [{'use_sim_time': use_sim_time}],
        'remappings': [('chatter', topic)],
        'output': 'screen',
    }

    return LaunchDescription([
        DeclareLaunchArgument('use_sim_time', default_value='true', description='Use the clock of the simulation'),
        DeclareLaunchArgument('topic', default_value='chatter', description='Topic of both nodes'),
        DeclareLaunchArgument('namespace', default_value='', description='Namespace of both nodes'),
        Node(executable='talker', name='talker', **common),
        Node(executable='listener', name='listener', **common),
    ])
