"""A network namespace for a child process, whose sockets and missing interfaces affect nobody else."""

from __future__ import annotations

import subprocess
import sys

import pytest

# The first lines of the child's program. In its namespace the loopback interface is down, and every port is free.
OWN_NETWORK = """
import os
try:
    os.unshare(os.CLONE_NEWNET)
except PermissionError:
    os.unshare(os.CLONE_NEWUSER | os.CLONE_NEWNET)
"""


def _is_allowed() -> bool:
    return subprocess.run([sys.executable, "-c", OWN_NETWORK], capture_output=True, check=False).returncode == 0


needs_own_network = pytest.mark.skipif(not _is_allowed(), reason="this machine allows no network namespaces")
