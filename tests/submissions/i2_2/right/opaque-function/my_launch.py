from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def start_nodes(context, *args, **kwargs):
    topic = LaunchConfiguration('topic').perform(context)
    namespace = LaunchConfiguration('namespace').perform(context)
    full = f'/{namespace}/{topic}' if namespace else f'/{topic}'
    options = {'package': 'demo_nodes_py', 'remappings': [('chatter', full)], 'output': 'screen'}
    if namespace:
        options['namespace'] = namespace
    return [
        LogInfo(msg=f'both nodes use {full}'),
        Node(executable='talker', **options),
        Node(executable='listener', **options),
    ]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='news'),
        DeclareLaunchArgument('namespace', default_value=''),
        OpaqueFunction(function=start_nodes),
    ])
