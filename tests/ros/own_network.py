"""A network namespace for one child process: what it binds or lacks there disturbs nobody."""

from __future__ import annotations

import subprocess
import sys

import pytest

# The first lines of the child's program. Its loopback interface is down, and every port is free.
OWN_NETWORK = """
import os
try:
    os.unshare(os.CLONE_NEWNET)
except PermissionError:
    os.unshare(os.CLONE_NEWUSER | os.CLONE_NEWNET)
"""


def _allowed() -> bool:
    return subprocess.run([sys.executable, "-c", OWN_NETWORK], capture_output=True, check=False).returncode == 0


needs_own_network = pytest.mark.skipif(not _allowed(), reason="this machine allows no network namespaces")
