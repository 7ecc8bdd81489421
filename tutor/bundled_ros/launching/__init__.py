"""Run launch files with the installed `launch`, or else with a subset of it.

The subset is in `launch/` and `launch_ros/`. Launch files know its parts by the names of the real packages, which
`real_names` makes importable, only in the process that runs a launch file.
"""

from tutor.bundled_ros.launching.runner import run

__all__ = ["run"]
