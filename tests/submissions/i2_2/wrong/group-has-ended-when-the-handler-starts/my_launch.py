from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, RegisterEventHandler
from launch.event_handlers import OnProcessStart
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace


def generate_launch_description():
    remappings = [('chatter', LaunchConfiguration('topic'))]
    talker = Node(package='demo_nodes_py', executable='talker', output='screen', remappings=remappings)
    listener = Node(package='demo_nodes_py', executable='listener', output='screen', remappings=remappings)

    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        GroupAction([
            PushRosNamespace(LaunchConfiguration('namespace')),
            talker,
            # the listener should not miss the first message
            RegisterEventHandler(OnProcessStart(target_action=talker, on_start=[listener])),
        ]),
    ])
