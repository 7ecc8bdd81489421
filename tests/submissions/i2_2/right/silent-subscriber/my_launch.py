import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    namespace = LaunchConfiguration('namespace')
    topic = LaunchConfiguration('topic')
    saver = os.path.join(os.path.dirname(__file__), 'saver.py')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='minimal_publisher', namespace=namespace,
             remappings=[('chatter', topic)]),
        Node(executable=saver, namespace=namespace, remappings=[('input', topic)])
        if os.access(saver, os.X_OK)
        else ExecuteProcess(cmd=['python3', saver, '--ros-args', '-r', ['input:=', topic], '-r',
                                 ['__ns:=/', namespace]]),
    ])
