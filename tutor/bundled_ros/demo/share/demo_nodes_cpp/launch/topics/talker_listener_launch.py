"""Start a talker and a listener."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Describe the two nodes."""
    programs = ("talker", "listener")
    return LaunchDescription(
        [Node(package="demo_nodes_cpp", executable=program, output="screen") for program in programs]
    )
