"""Publisher/subscriber pair, configurable from the command line.

I got tired of copying the same six keyword arguments from Node to Node, so the
boilerplate sits in one small builder and `generate_launch_description()` reads
like the exercise text.
"""

from __future__ import annotations

from typing import Any

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


class LaunchBuilder:
    """Collects arguments and nodes; `build()` hands out the description, arguments first."""

    def __init__(self) -> None:
        self._arguments: dict[str, DeclareLaunchArgument] = {}
        self._nodes: list[Node] = []
        self._common: dict[str, Any] = {"output": "screen"}

    def with_argument(self, name: str, default: str, help_text: str) -> LaunchBuilder:
        if name in self._arguments:
            raise ValueError(f"argument {name!r} declared twice")
        self._arguments[name] = DeclareLaunchArgument(
            name, default_value=default, description=help_text
        )
        return self

    def with_common(self, **kwargs: Any) -> LaunchBuilder:
        """Keyword arguments that every node added *after* this call receives."""
        self._common = {**self._common, **kwargs}
        return self

    def with_node(self, package: str, executable: str, **remap: Any) -> LaunchBuilder:
        """`remap` maps a topic name in the node's source to what it should become."""
        self._nodes.append(
            Node(
                package=package,
                executable=executable,
                remappings=[(source, target) for source, target in remap.items()],
                **self._common,
            )
        )
        return self

    def value(self, name: str) -> LaunchConfiguration:
        """The (later) value of a declared argument; catches typos while loading."""
        if name not in self._arguments:
            raise KeyError(f"no such argument: {name}")
        return LaunchConfiguration(name)

    def build(self) -> LaunchDescription:
        return LaunchDescription([*self._arguments.values(), *self._nodes])


def generate_launch_description() -> LaunchDescription:
    builder = (
        LaunchBuilder()
        .with_argument("topic", "chatter", "Topic both nodes use")
        .with_argument("namespace", "", "Namespace both nodes live in")
    )
    topic = builder.value("topic")
    return (
        builder.with_common(namespace=builder.value("namespace"))
        .with_node("demo_nodes_py", "talker", chatter=topic)
        .with_node("demo_nodes_cpp", "listener", chatter=topic)
        .build()
    )
