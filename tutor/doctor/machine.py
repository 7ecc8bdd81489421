"""Examinations of the machine: Python, network, shared memory, folders."""

from __future__ import annotations

import platform
import sys
import tempfile
from pathlib import Path

from tutor.doctor.finding import Finding
from tutor.ros import shared_memory
from tutor.ros.discovery import loopback_multicast_works, require_loopback

_PYTHONS = ((3, 12), (3, 13))
"""What ros-tutor is tested with; a ROS 2 Jazzy that is installed and sourced runs on 3.12 alone."""

_BYTES_PER_NODE = 700_000
"""Shared memory of one node, as measured: a segment, and the ports on which it listens."""
_NODES = 20
"""Warn if shared memory has room for fewer nodes than this."""


def python_version(version: tuple[int, int] = sys.version_info[:2], platform_name: str | None = None) -> Finding:
    """Examine whether this is a Python and the platform that ROS 2 Jazzy is built for."""
    where = platform_name or f"{platform.system()} {platform.machine()}"
    text = f"Python {'.'.join(map(str, version))} on {where}"
    if version not in _PYTHONS:
        hint = "Install ros-tutor with Python 3.12, for example: uv tool install --python 3.12 ros-tutor"
        return Finding("Python", False, f"{text}; ros-tutor needs Python 3.12 or 3.13.", hint)
    if where != "Linux x86_64":
        hint = "Use Linux on x86-64 (WSL 2 on Windows, or a virtual machine), or install ROS 2 Jazzy and source it."
        return Finding("Python", None, f"{text}; the bundled ROS is built for Linux x86_64 only.", hint)
    return Finding("Python", True, text)


def loopback() -> Finding:
    """Examine whether a datagram to 127.0.0.1 arrives."""
    try:
        require_loopback()
    except OSError as error:
        text = f"Nothing can be sent to 127.0.0.1 ({error})."
        return Finding("Loopback network", False, text, "Switch the loopback interface on: sudo ip link set lo up")
    return Finding("Loopback network", True, "127.0.0.1 answers")


def loopback_multicast() -> Finding:
    """Examine whether multicast works on the loopback interface: with it, discovery is immediate."""
    if loopback_multicast_works():
        return Finding("Loopback multicast", True, "multicast on the loopback interface works")
    return Finding(
        "Loopback multicast",
        None,
        "Multicast on the loopback interface does not work. Checks use another way for nodes to find each other, "
        "which is slower.",
        "Allow it, and look for a firewall that blocks 239.0.0.0/8: sudo ip link set lo multicast on",
    )


def shared_memory_room() -> Finding:
    """Examine whether enough shared memory is free for ROS to load, and for nodes to use it."""
    name = "Shared memory"
    space = shared_memory.free_space()
    if space is None:
        return Finding(name, True, "this machine sets no limit on it")
    size, free = _megabytes(space.size), _megabytes(space.free)
    hint = shared_memory.HINT[0].upper() + shared_memory.HINT[1:] + "."
    if not space.enough:
        return Finding(name, False, f"{space.folder} is full ({size}), so ROS cannot be loaded.", hint)
    if space.free < _BYTES_PER_NODE * _NODES:
        text = f"{space.folder} has {free} of {size} left, which is little: each node takes {_BYTES_PER_NODE / 1e6} MB."
        return Finding(name, None, f"{text} Without it, nodes print errors and send over the network instead.", hint)
    return Finding(name, True, f"{space.folder} has {free} of {size} left")


def temporary_files() -> Finding:
    """Examine whether temporary files, such as the logs of a check, can be written."""
    name = "Temporary files"
    hint = "Free some space there, or set TMPDIR to a folder that you may write to: export TMPDIR=$HOME/tmp"
    try:
        folder = Path(tempfile.gettempdir())
    except FileNotFoundError as error:
        return Finding(name, False, f"There is no folder for temporary files ({error.strerror}).", hint)
    if (fault := _try_writing(folder)) is not None:
        return Finding(name, False, f"{folder} cannot be written to ({fault}).", hint)
    return Finding(name, True, f"{folder} can be written to")


def workspace(root: Path) -> Finding:
    """Examine whether the workspace can be written to or, if it does not exist yet, created. Does not create it."""
    name = "Workspace"
    folder = root
    while not folder.exists() and not folder.is_symlink() and folder != folder.parent:
        folder = folder.parent
    if not folder.is_dir():
        text = f"{root} cannot be a folder: {folder} is something else."
        return Finding(name, False, text, "Choose another folder with --workspace DIR, or move that file away.")
    if (fault := _try_writing(folder)) is not None:
        hint = f"Choose another folder with --workspace DIR, or make this one yours: sudo chown -R $USER {folder}"
        return Finding(name, False, f"{folder} cannot be written to ({fault}).", hint)
    return Finding(name, True, f"{root} can be written to" if folder == root else f"{root} can be created")


def _megabytes(size: int) -> str:
    return f"{size / 2**20:.0f} MB"


def _try_writing(folder: Path) -> str | None:
    """Try to write a file into a folder; return why it fails, or None if it works."""
    try:
        with tempfile.NamedTemporaryFile(dir=folder, prefix=".ros-tutor-") as file:
            file.write(b"\0" * 65536)  # enough to notice a full disk
            file.flush()
    except OSError as error:
        return error.strerror or str(error)
    return None
