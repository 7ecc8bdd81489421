"""A container as Gradescope starts one, made with bubblewrap: root with Docker's privileges, and a small /dev/shm."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

ROOT = Path("/autograder")
UV = Path(__file__).resolve().parents[2] / ".uv-tool" / "bin"
_CACHE = Path(os.environ.get("UV_CACHE_DIR") or Path.home() / ".cache" / "uv")
_CAPABILITIES = (
    *("CHOWN", "DAC_OVERRIDE", "FOWNER", "FSETID", "KILL", "SETGID", "SETUID", "SETPCAP", "NET_BIND_SERVICE"),
    *("NET_RAW", "SYS_CHROOT", "MKNOD", "AUDIT_WRITE", "SETFCAP"),
)
_SHM_BYTES = 64 << 20
IS_ROOT = os.getuid() == 0
"""Without, only one user exists in a container: nothing in it can run as nobody."""


def run(
    folder: Path,
    command: Sequence[str],
    *,
    more: Mapping[Path, Path] | None = None,
    network: bool = False,
    env: Mapping[str, str] | None = None,
    limit_s: float = 600.0,
) -> subprocess.CompletedProcess[str]:
    """Run a command in a new container. `folder` is its /autograder; `more`: what is mounted on top of it, by path."""
    argv = ["bwrap", "--die-with-parent", "--unshare-pid", "--unshare-ipc", "--unshare-uts"]
    argv += [] if network else ["--unshare-net"]
    if IS_ROOT:
        argv += ["--cap-drop", "ALL", *(word for name in _CAPABILITIES for word in ("--cap-add", f"CAP_{name}"))]
    else:
        argv += ["--unshare-user", "--uid", "0", "--gid", "0"]
    argv += ["--ro-bind", "/usr", "/usr", "--ro-bind", "/etc", "/etc"]
    for link in ("/bin", "/sbin", "/lib", "/lib32", "/lib64"):
        if os.path.islink(link):
            argv += ["--symlink", os.readlink(link), link]
    argv += ["--proc", "/proc", "--dev", "/dev", "--tmpfs", "/tmp", "--chmod", "1777", "/tmp"]
    argv += ["--size", str(_SHM_BYTES), "--tmpfs", "/dev/shm", "--chmod", "1777", "/dev/shm"]
    argv += ["--ro-bind", "/dev/null", "/usr/bin/bwrap"]  # Gradescope's images are without it
    python = Path(sys.base_prefix)
    if not python.is_relative_to("/usr"):
        for parent in reversed(python.parents[:-1]):
            argv += ["--perms", "0755", "--dir", str(parent)]
        argv += ["--ro-bind", str(python), str(python)]
    if network:
        argv += ["--ro-bind-try", str(UV / "uv"), "/opt/uv/uv", "--bind-try", str(_CACHE), "/opt/uv-cache"]
    for inside, outside in {ROOT: folder, **(more or {})}.items():
        argv += ["--bind", str(outside), str(inside)]
    path = f"/opt/uv:/usr/local/bin:/usr/bin:/bin:{python}/bin"
    variables = {"PATH": path, "HOME": "/root", "UV_CACHE_DIR": "/opt/uv-cache", "UV_LINK_MODE": "copy", **(env or {})}
    argv += ["--clearenv", *(word for pair in variables.items() for word in ("--setenv", *pair))]
    argv += ["--chdir", str(ROOT), "--", *command]
    return subprocess.run(argv, capture_output=True, text=True, errors="replace", timeout=limit_s, check=False)


@cache
def is_possible() -> bool:
    """Whether this machine can run such containers."""
    try:
        return run(Path(__file__).parent, ["true"]).returncode == 0
    except FileNotFoundError:
        return False
