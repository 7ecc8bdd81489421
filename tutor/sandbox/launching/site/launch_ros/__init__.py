"""The part of ROS 2's `launch_ros` that launch files for the exercises use, where no real one is installed."""

from launch._unsupported import lazily_refusing

from . import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]

__getattr__ = lazily_refusing(
    __name__, frozenset({"event_handlers", "events", "get_default_launch_description", "ros_adapters"})
)
