from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch.conditions import IfCondition
from launch.substitutions import PythonExpression

def generate_launch_description():
    c = IfCondition(PythonExpression(["'", LaunchConfiguration('namespace'), "' != ''"]))
    return LaunchDescription([*[DeclareLaunchArgument('topic', default_value='chatter', description='Topic'), DeclareLaunchArgument('namespace', default_value='', description='Namespace')],
        Node(package='demo_nodes_py', executable='talker', namespace=LaunchConfiguration('namespace'), remappings=[('chatter', LaunchConfiguration('topic'))], condition=c),
        Node(package='demo_nodes_py', executable='listener', namespace=LaunchConfiguration('namespace'), remappings=[('chatter', LaunchConfiguration('topic'))], condition=c),
    ])
