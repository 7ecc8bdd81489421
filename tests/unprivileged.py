"""Run programs as an ordinary user: root may look into every process."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache

# If Python lies in a folder that only root may enter, bind-mount it at the same path in a private mount namespace.
_REMOUNT_PYTHON = """
python=$0; top=/$(echo "$python" | cut -d/ -f2)
mount --bind "$python" /mnt && mount -t tmpfs -o mode=755 none "$top" && mkdir -p "$python" &&
mount --bind /mnt "$python" && exec "$@"
"""
_NOBODY = "65534"


@cache
def prefix() -> tuple[str, ...] | None:
    """Return the prefix that runs a command of our Python as an ordinary user; None if that is impossible here."""
    if os.getuid() != 0:
        return ()
    drop = ("setpriv", "--reuid", _NOBODY, "--regid", _NOBODY, "--clear-groups", "--bounding-set=-all")
    for candidate in (drop, ("unshare", "-m", "sh", "-c", _REMOUNT_PYTHON, sys.base_prefix, *drop)):
        try:
            ran = subprocess.run([*candidate, sys.executable, "-I", "-c", "import tutor.process"], capture_output=True)
        except FileNotFoundError:
            return None
        if ran.returncode == 0:
            return candidate
    return None
