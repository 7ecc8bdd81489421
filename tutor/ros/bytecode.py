"""Compiled modules for learners' processes, which write none themselves: some installers leave that to the first import.

Without them each start compiles rclpy anew, which takes three times as long as the start itself.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
from pathlib import Path

from tutor.ros.environment import RosEnvironment, learner_env

_USED = "import example_interfaces.srv, rcl_interfaces.srv, rclpy, rclpy.executors, std_msgs.msg"
_LIMIT_S = 60.0


def ensure(ros: RosEnvironment) -> None:
    """Have the modules that nodes use compiled, once, where the bundled ROS is not.

    Does nothing where they are, or where its folder cannot be written to: then starts are slow, but right.
    """
    found = importlib.util.find_spec("rclpy") if ros.kind == "bundled" else None
    if found is None or found.origin is None or Path(importlib.util.cache_from_source(found.origin)).exists():
        return
    if not os.access(Path(found.origin).parent, os.W_OK):
        return
    env = learner_env(ros, domain_id=0, log_dir=Path(os.devnull), package_root=None, isolated=True)
    env.pop("PYTHONDONTWRITEBYTECODE", None)
    subprocess.run([str(ros.python), "-c", _USED], env=env, capture_output=True, timeout=_LIMIT_S, check=False)
