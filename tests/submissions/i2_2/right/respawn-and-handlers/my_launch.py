from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, LogInfo, RegisterEventHandler
from launch.event_handlers import OnProcessExit, OnProcessStart, OnShutdown
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')
    listener = Node(package='demo_nodes_cpp', executable='listener', namespace=namespace,
                    remappings=[('chatter', topic)], output='screen', respawn=True, respawn_delay=1.0)
    talker = Node(package='demo_nodes_cpp', executable='talker', namespace=namespace,
                  remappings=[('chatter', topic)], output='screen')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        listener,
        RegisterEventHandler(OnProcessStart(target_action=listener, on_start=[LogInfo(msg='listening'), talker])),
        RegisterEventHandler(OnProcessExit(target_action=talker, on_exit=[EmitEvent(event=Shutdown(reason='done'))])),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg='bye')])),
    ])
