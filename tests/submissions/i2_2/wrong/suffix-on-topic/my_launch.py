from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import *
from launch.substitutions import *
from launch_ros.actions import Node

def generate_launch_description():
    topic = LaunchConfiguration('topic')
    ns = LaunchConfiguration('namespace')
    out = [DeclareLaunchArgument('topic', default_value='chatter'), DeclareLaunchArgument('namespace', default_value='')]
    for e in ('talker', 'listener'):
        out.append(Node(package='demo_nodes_cpp', executable=e, namespace=ns, remappings=[('chatter', [topic, '_data'])]))
    return LaunchDescription(out)
