"""Where the interface packages of a workspace are once `tutor.interfaces` has built them, and how a process finds them.

Each is an ament prefix in the user's cache folder, named after a digest of all that it was made of. A workspace has a
folder of links to its own, so that a terminal opened before a change finds what was built after it.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, MutableMapping
from pathlib import Path

SITE_PACKAGES = Path("python")
"""The folder of a prefix from which Python imports the package."""


def cache_root(environ: Mapping[str, str] = os.environ) -> Path:
    """Return the folder for all that is built, which need not exist: in the user's cache folder. Raises OSError."""
    if (given := environ.get("XDG_CACHE_HOME", "")) and os.path.isabs(given):
        return Path(given, "ros-tutor", "interfaces")
    home = Path(os.path.expanduser("~"))
    if home.is_dir() and os.access(home, os.W_OK):
        return home / ".cache" / "ros-tutor" / "interfaces"
    from tutor import private_folders  # late: every `ros2` command imports this module

    return private_folders.base() / "interfaces"


def links_folder(workspace: Path) -> Path:
    """Return the folder with a link to each built package of a workspace, by its name. Raises OSError."""
    place = hashlib.sha256(os.fsencode(os.path.realpath(workspace))).hexdigest()[:16]
    return cache_root() / "workspaces" / place


def built(workspace: Path) -> list[Path]:
    """Return the prefixes of a workspace's packages that are built; some may be of an older state of their files."""
    try:
        return sorted(link for link in links_folder(workspace).iterdir() if link.is_dir())
    except OSError:
        return []


def add(env: MutableMapping[str, str], workspace: Path) -> None:
    """Make processes with this environment find the built packages of a workspace, before any others of their names."""
    add_prefixes(env, built(workspace))


def add_prefixes(env: MutableMapping[str, str], found: list[Path]) -> None:
    """Make processes with this environment find the packages in these prefixes."""
    for name, folders in (
        ("AMENT_PREFIX_PATH", found),
        ("PYTHONPATH", [prefix / SITE_PACKAGES for prefix in found]),
        ("LD_LIBRARY_PATH", [prefix / "lib" for prefix in found]),
    ):
        if folders:
            before = [entry for entry in env.get(name, "").split(os.pathsep) if entry]
            env[name] = os.pathsep.join(dict.fromkeys([*map(str, folders), *before]))


def kept(environ: Mapping[str, str], name: str) -> Iterator[str]:
    """Yield the entries of a PATH-like variable that are in built packages."""
    for entry in environ.get(name, "").split(os.pathsep):
        if entry and is_built(entry):
            yield entry


def is_built(entry: str | Path) -> bool:
    """Return whether a path is in a package that was built for a workspace."""
    try:
        return Path(entry).is_relative_to(cache_root())
    except OSError:
        return False
