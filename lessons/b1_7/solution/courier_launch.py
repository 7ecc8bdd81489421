#!/usr/bin/env python3
"""The courier, a small delivery robot: its four nodes."""

from pathlib import Path

from launch import LaunchDescription
from launch_ros.actions import Node

HERE = Path(__file__).resolve()
PARAMETERS = str(HERE.with_name("courier_parameters.yaml"))


def generate_launch_description() -> LaunchDescription:
    """Describe what to start. Launch calls this."""
    return LaunchDescription(
        [
            Node(
                package="my_package",
                executable="courier_battery",
                namespace="courier",
                parameters=[PARAMETERS],
            ),
            Node(
                package="my_package",
                executable="courier_planner",
                namespace="courier",
                parameters=[PARAMETERS],
            ),
            Node(
                package="my_package",
                executable="courier_driver",
                namespace="courier",
                parameters=[PARAMETERS],
            ),
            Node(
                package="my_package",
                executable="courier_monitor",
                namespace="courier",
                parameters=[PARAMETERS],
            ),
        ]
    )
