"""The part of ROS 2's `launch_ros` that launch files for the exercises use, where no real one is installed."""

import sys

from launch import _real_names

from . import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]

_real_names.complete(sys.modules[__name__])  # the finder has done so, unless this was imported before `launch`
