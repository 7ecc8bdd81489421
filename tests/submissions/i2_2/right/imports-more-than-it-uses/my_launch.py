from pathlib import Path
from typing import Optional

import lifecycle_msgs.msg
from launch import LaunchDescription, LaunchIntrospector
from launch.actions import OpaqueCoroutine, OpaqueFunction
from launch.frontend import Parser
from launch.launch_description import DeclareLaunchArgument
from launch.launch_context import LaunchContext, Text
from launch.substitutions import LaunchConfiguration, LaunchLogDir, PathSubstitution
from launch_ros.actions import ComposableNodeContainer, LifecycleNode, LoadComposableNodes, Node, ROSTimer
from launch_ros.descriptions import ComposableNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.substitutions import FindPackageShare, Parameter
from launch_testing.actions import ReadyToTest


def node_of(context: LaunchContext, container: Optional[ComposableNodeContainer] = None) -> list:
    name: Text = LaunchConfiguration('executable').perform(context)
    return [Node(package='my_package', executable=name, namespace=LaunchConfiguration('namespace'),
                 remappings=[('chatter', LaunchConfiguration('topic'))],
                 additional_env={'CONFIG': PathSubstitution(FindPackageShare('my_package')) / Path('config') / 'a.yaml'})]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        DeclareLaunchArgument('executable', default_value='minimal_publisher'),
        OpaqueFunction(function=node_of),
        Node(package='my_package', executable='minimal_subscriber', namespace=LaunchConfiguration('namespace'),
             remappings=[('chatter', LaunchConfiguration('topic'))]),
    ])
