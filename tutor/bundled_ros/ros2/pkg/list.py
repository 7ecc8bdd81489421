"""`ros2 pkg list`."""

from __future__ import annotations

import argparse

from tutor.bundled_ros.ros2.pkg.names import all_packages


def main(_: argparse.Namespace) -> None:
    """Print the packages."""
    for name in all_packages():
        print(name)
