"""Programs as an ordinary user runs them: root may look into every process."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache

# Where root keeps Python in a folder that nobody else may enter, it is mounted there again, in a private namespace.
_MADE_REACHABLE = """
python=$0; top=/$(echo "$python" | cut -d/ -f2)
mount --bind "$python" /mnt && mount -t tmpfs -o mode=755 none "$top" && mkdir -p "$python" &&
mount --bind /mnt "$python" && exec "$@"
"""
_NOBODY = "65534"


@cache
def prefix() -> tuple[str, ...] | None:
    """What a command of our Python is to be preceded by; None where it cannot be run so."""
    if os.getuid() != 0:
        return ()
    drop = ("setpriv", "--reuid", _NOBODY, "--regid", _NOBODY, "--clear-groups", "--bounding-set=-all")
    for tried in (drop, ("unshare", "-m", "sh", "-c", _MADE_REACHABLE, sys.base_prefix, *drop)):
        try:
            ran = subprocess.run([*tried, sys.executable, "-I", "-c", "import tutor.process"], capture_output=True)
        except FileNotFoundError:
            return None
        if ran.returncode == 0:
            return tried
    return None
