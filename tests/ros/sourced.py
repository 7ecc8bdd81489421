"""A mock installation of ROS 2 Jazzy, assembled from the wheels, and the variables that sourcing it sets."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

from tutor.ros import bundled_interfaces, prefixes

_SITE = prefixes.SITE_PACKAGES
_SYSTEM_PACKAGES = ("numpy", "numpy.libs", "yaml", "_yaml")  # dependencies that a system Python brings along


def install(prefix: Path) -> Path:
    """Install ROS into `prefix` as real files (hard links where possible), so that /proc shows which files are used."""
    own = Path(sys.prefix)
    for record in (own / _SITE).glob("ros_*.dist-info/RECORD"):
        if not record.parent.name.startswith(("ros_tutor", "ros_wheels_bootstrapper", "ros_jazzy")):
            for line in record.read_text().splitlines():
                _install_file(own / _SITE, line.rsplit(",", 2)[0], own, prefix)
    for name in _SYSTEM_PACKAGES:
        shutil.copytree(own / _SITE / name, prefix / _SITE / name, copy_function=_link_or_copy)
    shutil.copytree(bundled_interfaces.prefix(), prefix, copy_function=_link_or_copy, dirs_exist_ok=True)
    return prefix


def source(prefix: Path) -> dict[str, str]:
    """Return the variables that sourcing the installation's setup.bash sets."""
    bundles = sorted((prefix / _SITE).glob("ros_*.libs"))
    return {
        "ROS_DISTRO": "jazzy",
        "ROS_VERSION": "2",
        "ROS_PYTHON_VERSION": "3",
        "AMENT_PREFIX_PATH": str(prefix),
        "PYTHONPATH": str(prefix / _SITE),
        "LD_LIBRARY_PATH": os.pathsep.join(map(str, [prefix / "lib", *bundles])),
        "PATH": os.pathsep.join([str(prefix / "bin"), os.environ["PATH"]]),
    }


def _install_file(site: Path, name: str, own: Path, prefix: Path) -> None:
    file = Path(os.path.normpath(site / name))
    target = prefix / file.relative_to(own)
    if file.is_file() and not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        _link_or_copy(str(file), str(target))


def _link_or_copy(file: str, target: str) -> None:
    try:
        os.link(file, target)
    except OSError:
        shutil.copy2(file, target)
