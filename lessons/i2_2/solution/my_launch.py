#!/usr/bin/env python3
"""Exercise I2.2: one command that starts a publisher and a subscriber, with arguments for topic and namespace."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Describe what to start. Launch calls this."""
    topic_argument = DeclareLaunchArgument("topic", default_value="chatter", description="Topic that both nodes use")
    namespace_argument = DeclareLaunchArgument("namespace", default_value="", description="Namespace of both nodes")

    # These stand for the values, which are known only once the launch runs.
    topic = LaunchConfiguration("topic")
    namespace = LaunchConfiguration("namespace")

    publisher = Node(
        package="my_package",
        executable="minimal_publisher",
        namespace=namespace,
        remappings=[("chatter", topic)],
        output="screen",
    )
    subscriber = Node(
        package="my_package",
        executable="minimal_subscriber",
        namespace=namespace,
        remappings=[("chatter", topic)],
        output="screen",
    )
    return LaunchDescription([topic_argument, namespace_argument, publisher, subscriber])
