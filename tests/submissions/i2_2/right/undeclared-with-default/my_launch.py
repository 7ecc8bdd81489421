from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    kw = dict(package='demo_nodes_py', namespace=LaunchConfiguration('namespace', default=''), remappings=[('chatter', LaunchConfiguration('topic', default='chatter'))])
    return LaunchDescription([Node(executable='talker', **kw), Node(executable='listener', **kw)])
