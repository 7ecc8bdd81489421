#!/usr/bin/env python3
"""Exercise I2.2: one command that starts a publisher and a subscriber.

Its arguments set their topic and namespace.
"""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Describe what to start. Launch calls this.

    So far it is one node, which nobody listens to.
    """
    # TODO 2: declare the argument topic, with the default "chatter":
    #         DeclareLaunchArgument, from launch.actions. Its value is
    #         LaunchConfiguration("topic"), from launch.substitutions.

    # TODO 4: declare the argument namespace, with the default "".

    publisher = Node(
        package="my_package",
        executable="minimal_publisher",
        output="screen",
        # TODO 3: remap "chatter" to the value of topic:
        #         remappings=[(..., ...)].
        # TODO 5: put the node into the namespace: namespace=...
    )

    # TODO 1: start minimal_subscriber in the same way. Once the
    #         publisher has them, it needs TODO 3 and TODO 5, too.

    # Launch starts only what is in this list. The arguments belong in
    # it as well.
    return LaunchDescription([publisher])
