"""Installs ros-tutor from the files beside this one: `python3 install.py HOME` makes HOME/venv/bin/python.

It needs Python 3.8 or later, a network, and nothing else: uv gets the CPython that the wheel is for if there is none.
The uv on PATH is used, or else one from PyPI.
"""

from __future__ import annotations

import glob
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
CERTIFICATES = (
    "/etc/ssl/certs/ca-certificates.crt",
    "/etc/pki/tls/certs/ca-bundle.crt",
    "/etc/ssl/ca-bundle.pem",
)


def main() -> int:
    """Install; return 0 if that worked."""
    home = os.path.abspath(sys.argv[1])
    venv = os.path.join(home, "venv")
    shutil.rmtree(venv, ignore_errors=True)
    os.makedirs(home, exist_ok=True)
    uv = shutil.which("uv") or get_uv(os.path.join(home, "uv"))
    if uv is None:
        print("ros-tutor: uv is not installed, and cannot be got from PyPI with this python3", file=sys.stderr)
        return 1
    (wheel,) = glob.glob(os.path.join(HERE, "ros_tutor-*.whl"))
    version = os.path.basename(wheel).split("-")[2].replace("cp3", "3.")  # such as cp312
    install = ["pip", "install", "--python", os.path.join(venv, "bin", "python")]
    install += ["--constraint", os.path.join(HERE, "constraints.txt"), wheel]
    # Not in the current folder, which may be a submission with settings for uv.
    for command in (["venv", "--python", version, venv], install):
        done = subprocess.run([uv, command[0], "--quiet", *command[1:]], cwd=home, env=environment(home))
        if done.returncode != 0:
            print("ros-tutor: cannot be installed, for the reason above", file=sys.stderr)
            return 1
    return 0


def get_uv(folder: str) -> str | None:
    """Install uv from PyPI into a folder; return its path, or None if that fails."""
    path = os.path.join(folder, "bin", "uv")
    own = [os.path.join(folder, "bin", "python"), "-I", "-m", "pip", "install", "--quiet", "uv"]
    # Debian's python3 comes without venv; its pip, if it is there, can still install into a folder.
    ours = [sys.executable, "-I", "-m", "pip", "install", "--quiet", "--target", folder, "uv"]
    for commands in ([[sys.executable, "-I", "-m", "venv", folder], own], [ours]):
        shutil.rmtree(folder, ignore_errors=True)
        if all(os.path.exists(command[0]) and subprocess.run(command).returncode == 0 for command in commands):
            return path if os.path.exists(path) else None
    return None


def environment(home: str) -> dict[str, str]:
    """Return the environment for uv: all it downloads for good is below `home`."""
    env = {name: value for name, value in os.environ.items() if name not in ("UV_PYTHON", "VIRTUAL_ENV")}
    env["UV_PYTHON_INSTALL_DIR"] = os.path.join(home, "python")
    if any(map(os.path.isfile, CERTIFICATES)):  # a network may need its own, beside those that uv has
        env.setdefault("UV_SYSTEM_CERTS", "1")
        env.setdefault("UV_NATIVE_TLS", "1")
    return env


if __name__ == "__main__":
    sys.exit(main())
