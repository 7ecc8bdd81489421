"""`ros-tutor ros2`: the `ros2` command, even where no ROS 2 is installed."""

from __future__ import annotations

import argparse
import os
import shlex
import sys

from tutor.cli import context
from tutor.cli.interfaces import build_interfaces
from tutor.errors import UsageError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `COMMAND ...`."""
    parser.add_argument(
        "words",
        metavar="COMMAND ...",
        nargs=argparse.REMAINDER,
        help="as after ros2: topic echo /chatter",
    )


def run(arguments: argparse.Namespace) -> int:
    """Exec `ros2` in the user's own ROS domain; does not return. Raises UsageError if it cannot be started."""
    from tutor import interpreter, private_folders
    from tutor.bundled_ros.ros2.starting import ros2_command
    from tutor.errors import CommandError
    from tutor.ros import workspace_interfaces
    from tutor.ros.environment import detect, learner_env
    from tutor.workspace import domain_of

    ros = detect()
    workspace = context.choose_workspace(arguments)
    build_interfaces(workspace)
    domain = domain_of(workspace)
    env = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
    if ros.kind == "bundled":
        env = learner_env(
            ros,
            domain_id=domain,
            log_dir=private_folders.logs(),
            package_root=None,
            isolated=False,
        )
        env["ROS_TUTOR_WORKSPACE"] = str(workspace.root)
    workspace_interfaces.add(env, workspace.root)
    try:
        command = [*ros2_command(ros, env), *(arguments.words or ["--help"])]
    except CommandError as error:
        raise UsageError(str(error)) from error
    sys.stdout.flush()
    try:
        if ros.kind == "bundled":
            interpreter.exec_program(command, env)
        os.execve(command[0], command, env)
    except OSError as error:
        raise UsageError(f"{shlex.join(command)} cannot be started: {error.strerror}") from error
