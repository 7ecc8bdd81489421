"""Run launch files with the installed `launch`, or else with the subset of it in `site/`.

`site/` holds two packages named `launch` and `launch_ros`. They can be imported only in a process that runs a launch
file, and they import none of our own code.
"""

from tutor.bundled_ros.launching.runner import run

__all__ = ["run"]
