from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')
    no_namespace = PythonExpression(["'", namespace, "' == ''"])
    entries = [
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
    ]
    for program in ('talker', 'listener'):
        entries.append(Node(package='demo_nodes_py', executable=program, remappings=[('chatter', topic)],
                            output='screen', condition=IfCondition(no_namespace)))
        entries.append(Node(package='demo_nodes_py', executable=program, remappings=[('chatter', topic)],
                            namespace=namespace, output='screen', condition=UnlessCondition(no_namespace)))
    return LaunchDescription(entries)
