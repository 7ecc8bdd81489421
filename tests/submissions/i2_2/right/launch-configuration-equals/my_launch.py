from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch.conditions import LaunchConfigurationEquals, LaunchConfigurationNotEquals

def generate_launch_description():
    ns = LaunchConfiguration('namespace')
    remap = [('chatter', LaunchConfiguration('topic'))]
    nodes = []
    for exe in 'talker', 'listener':
        nodes.append(Node(package='demo_nodes_cpp', executable=exe, namespace=ns, remappings=remap, condition=LaunchConfigurationNotEquals('namespace', '')))
        nodes.append(Node(package='demo_nodes_cpp', executable=exe, remappings=remap, condition=LaunchConfigurationEquals('namespace', '')))
    return LaunchDescription([DeclareLaunchArgument('topic', default_value='chatter'), DeclareLaunchArgument('namespace', default_value=''), *nodes])
