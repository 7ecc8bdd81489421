"""Runs launch files: with the installed `launch` where there is one, else with the subset of it in `site/`.

`site/` holds two packages named `launch` and `launch_ros`. They are importable only in a process that runs a launch
file, and import none of our code.
"""

from tutor.bundled_ros.launching.runner import run

__all__ = ["run"]
