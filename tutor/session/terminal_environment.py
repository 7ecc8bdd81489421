"""The ROS and the environment of a sourced terminal in a workspace, in which learners' nodes run."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from tutor import private_folders
from tutor.bundled_ros.ros2 import sourced
from tutor.interfaces import build_workspace
from tutor.ros import shared_memory
from tutor.ros.environment import RosEnvironment, detect, learner_env
from tutor.workspace import Workspace


def ros_and_env(
    workspace: Workspace, domain: int, tools: Path, package: Path | None = None
) -> tuple[RosEnvironment, dict[str, str]]:
    """Return the ROS that nodes run with, and their environment; build the workspace's interface packages.

    `tools`: the folder into which the terminal's programs are written. `package`: the root of the learner's package,
    whose modules can be imported. Raises OSError if shared memory is full.
    """
    ros = detect()
    shared_memory.require_enough()
    if workspace.exists:
        with suppress(OSError):  # a node may need none of its types; what is not built is said elsewhere
            build_workspace(workspace.root, ros)
    env = learner_env(ros, domain_id=domain, log_dir=private_folders.logs(), package_root=package, isolated=False)
    sourced.write_programs(tools, ros, env)
    sourced.add_programs(env, tools)
    if ros.kind == "system":
        sourced.add_built_packages(env, workspace.root)
    sourced.add_workspace(env, workspace.root)
    return ros, env
