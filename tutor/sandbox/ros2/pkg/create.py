"""`ros2 pkg create`, which only an installed ROS 2 has."""

from __future__ import annotations

import argparse
from typing import NoReturn

from tutor.sandbox.ros2.errors import CommandError


def add_arguments(_: argparse.ArgumentParser) -> NoReturn:
    """Raise CommandError, whatever the arguments are."""
    raise CommandError("ros2 pkg create is not supported: it needs an installed ROS 2; my_package is there already", 2)


main = add_arguments
