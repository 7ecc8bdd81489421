"""Compiled modules for learners' processes, which write none themselves.

The ROS wheels bring compiled modules that are older than their sources, and some installers compile nothing; then each
start compiles rclpy again, and takes three times as long.
"""

from __future__ import annotations

import importlib.util
import os
import struct
import subprocess
from pathlib import Path

from tutor.ros.environment import RosEnvironment, learner_env

_USED = "import example_interfaces.srv, rcl_interfaces.srv, rclpy, rclpy.executors, std_msgs.msg"
_LIMIT_S = 60.0


def compile_ros_modules(ros: RosEnvironment) -> None:
    """Compile the modules that nodes use, once, where the bundled ROS is not compiled.

    Does nothing where they are, or where its folder cannot be written to: then starts are slow, but right.
    """
    found = importlib.util.find_spec("rclpy") if ros.kind == "bundled" else None
    if found is None or found.origin is None or _is_compiled(Path(found.origin)):
        return
    if not os.access(Path(found.origin).parent, os.W_OK):
        return
    env = learner_env(ros, domain_id=0, log_dir=Path(os.devnull), package_root=None, isolated=True)
    env.pop("PYTHONDONTWRITEBYTECODE", None)
    subprocess.run([str(ros.python), "-c", _USED], env=env, capture_output=True, timeout=_LIMIT_S, check=False)


def _is_compiled(source: Path) -> bool:
    try:
        header = Path(importlib.util.cache_from_source(source)).read_bytes()[:16]
        about = source.stat()
    except OSError:
        return False
    # PEP 552: magic number, flags (0: by time), the source's time of change and size, 4 bytes each.
    written = struct.pack("<4sIII", importlib.util.MAGIC_NUMBER, 0, int(about.st_mtime) & 0xFFFFFFFF, about.st_size)
    return header == written
