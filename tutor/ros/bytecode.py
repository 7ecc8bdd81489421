"""Bytecode for learners' processes, which run with PYTHONDONTWRITEBYTECODE.

The ROS wheels ship bytecode that is older than its sources, and some installers compile nothing. Then every start would
compile rclpy again and take three times as long.
"""

from __future__ import annotations

import importlib.util
import os
import struct
import subprocess
from pathlib import Path

from tutor.ros.environment import RosEnvironment, learner_env

_IMPORTS = "import example_interfaces.srv, rcl_interfaces.srv, rclpy, rclpy.executors, std_msgs.msg"
_LIMIT_S = 60.0


def compile_ros_modules(ros: RosEnvironment) -> None:
    """Compile the modules that nodes import, unless the bundled ROS is already compiled.

    Also does nothing if its folder is not writable: starts are slow then, but correct.
    """
    spec = importlib.util.find_spec("rclpy") if ros.kind == "bundled" else None
    if spec is None or spec.origin is None or _is_compiled(Path(spec.origin)):
        return
    if not os.access(Path(spec.origin).parent, os.W_OK):
        return
    env = learner_env(ros, domain_id=0, log_dir=Path(os.devnull), package_root=None, isolated=True)
    env.pop("PYTHONDONTWRITEBYTECODE", None)
    subprocess.run([str(ros.python), "-c", _IMPORTS], env=env, capture_output=True, timeout=_LIMIT_S, check=False)


def _is_compiled(source: Path) -> bool:
    try:
        header = Path(importlib.util.cache_from_source(source)).read_bytes()[:16]
        status = source.stat()
    except OSError:
        return False
    # PEP 552: magic number, flags (0: timestamp-based), source mtime and size, 4 bytes each.
    current = struct.pack("<4sIII", importlib.util.MAGIC_NUMBER, 0, int(status.st_mtime) & 0xFFFFFFFF, status.st_size)
    return header == current
