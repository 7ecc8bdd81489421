"""How to start the watcher process."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass

from tutor import interpreter


@dataclass(frozen=True, slots=True)
class WatcherCommand:
    """The child's command and complete environment; `domain` is the ROS domain that it watches."""

    argv: tuple[str, ...]
    env: Mapping[str, str]
    domain: int


def watcher_command(domain: int, environ: Mapping[str, str] = os.environ) -> WatcherCommand:
    """Return the command to watch a domain, with the discovery settings of the user's own nodes. Reads the disk."""
    from tutor.ros.environment import detect, tutor_env  # late import: keeps the first paint fast

    env = tutor_env(detect(environ), isolated=False, environ=environ)
    return WatcherCommand(interpreter.module_command("tutor.live"), {**env, "ROS_DOMAIN_ID": str(domain)}, domain)
