from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def demo(executable, *suffix):
    return Node(
        package="demo_nodes_py",
        executable=executable,
        namespace=[LaunchConfiguration("namespace"), *suffix],
        remappings=[("chatter", LaunchConfiguration("topic"))],
        output="screen",
    )


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value=""),
            DeclareLaunchArgument("topic", default_value="chatter"),
            demo("talker"),
            demo("listener", "/ears"),
        ]
    )
