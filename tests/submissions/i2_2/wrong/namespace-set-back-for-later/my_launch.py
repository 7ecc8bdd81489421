"""The listener follows when the talker has started; then the namespace is set back for what may come."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, RegisterEventHandler, SetLaunchConfiguration
from launch.event_handlers import OnProcessStart
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

SPACE, TOPIC = LaunchConfiguration("namespace"), LaunchConfiguration("topic")


def member(executable):
    return Node(
        package="demo_nodes_py",
        executable=executable,
        namespace=SPACE,
        remappings=[("chatter", TOPIC)],
    )


def generate_launch_description():
    talker, listener = member("talker"), member("listener")
    return LaunchDescription([
        DeclareLaunchArgument("topic", default_value="chatter"),
        DeclareLaunchArgument("namespace", default_value=""),
        RegisterEventHandler(OnProcessStart(target_action=talker, on_start=[listener])),
        talker,
        SetLaunchConfiguration("namespace", ""),
    ])
