"""The subset of ROS 2's `launch_ros` that the exercises' launch files use, for machines without the real one."""

import sys

from launch import _real_names

from . import actions, descriptions, parameter_descriptions, substitutions

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]

# The import hook has done this already, unless this package was imported before `launch`.
_real_names.complete(sys.modules[__name__])
