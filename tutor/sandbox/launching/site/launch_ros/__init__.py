"""The part of ROS 2's `launch_ros` that launch files for the exercises use, where no real one is installed."""

from . import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]
