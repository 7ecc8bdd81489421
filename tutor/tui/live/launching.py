"""How the watching child process is started."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass

from tutor import interpreter


@dataclass(frozen=True, slots=True)
class WatcherCommand:
    """The command and the whole environment of the child; `domain` is the ROS domain that it watches."""

    argv: tuple[str, ...]
    env: Mapping[str, str]
    domain: int


def watcher_command(domain: int, environ: Mapping[str, str] = os.environ) -> WatcherCommand:
    """Watch the domain with this id as a node of the user's would, with their settings of discovery. Reads the disk."""
    from tutor.ros.environment import detect, tutor_env  # late: the first paint does not wait for it

    env = tutor_env(detect(environ), isolated=False, environ=environ)
    return WatcherCommand(interpreter.module_command("tutor.live"), {**env, "ROS_DOMAIN_ID": str(domain)}, domain)
