import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

EAR = Path(__file__).parent / "ear.py"


def generate_launch_description():
    common = {
        "namespace": LaunchConfiguration("namespace"),
        "remappings": [("chatter", LaunchConfiguration("topic"))],
        "output": "screen",
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument("topic", default_value="chatter"),
            DeclareLaunchArgument("namespace", default_value=""),
            Node(package="demo_nodes_py", executable="talker", **common),
            Node(executable=sys.executable, arguments=[str(EAR), "--loud"], **common),
        ]
    )
