from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace


def generate_launch_description():
    namespace = LaunchConfiguration('namespace')
    use_namespace = LaunchConfiguration('use_namespace')
    remappings = [('chatter', LaunchConfiguration('topic'))]

    bringup = GroupAction([
        PushRosNamespace(condition=IfCondition(use_namespace), namespace=namespace),
        Node(package='demo_nodes_py', executable='talker', output='screen', remappings=remappings),
        Node(package='demo_nodes_py', executable='listener', output='screen', remappings=remappings),
    ])

    ld = LaunchDescription()
    ld.add_action(DeclareLaunchArgument('namespace', default_value=''))
    ld.add_action(DeclareLaunchArgument('use_namespace', default_value='false'))
    ld.add_action(DeclareLaunchArgument('topic', default_value='chatter'))
    ld.add_action(bringup)
    return ld
