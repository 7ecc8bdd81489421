"""A made-up installation of ROS 2 Jazzy, put together from the wheels, and the variables that sourcing it would set."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

from tutor.ros import bundled_interfaces

_SITE = Path("lib") / "python3.12" / "site-packages"
_NOT_OF_ROS = ("numpy", "numpy.libs", "yaml", "_yaml")  # what a system Python has beside ROS, and ours has not


def install(prefix: Path) -> Path:
    """Put ROS into `prefix`: real files (hard links where possible), so that a process shows which ones it uses."""
    own = Path(sys.prefix)
    for record in (own / _SITE).glob("ros_*.dist-info/RECORD"):
        if not record.parent.name.startswith(("ros_tutor", "ros_wheels_bootstrapper", "ros_jazzy")):
            for line in record.read_text().splitlines():
                _put(own / _SITE, line.rsplit(",", 2)[0], own, prefix)
    for name in _NOT_OF_ROS:
        shutil.copytree(own / _SITE / name, prefix / _SITE / name, copy_function=_link)
    shutil.copytree(bundled_interfaces.prefix(), prefix, copy_function=_link, dirs_exist_ok=True)
    return prefix


def source(prefix: Path) -> dict[str, str]:
    """The variables that sourcing the installation's setup.bash sets."""
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


def _put(site: Path, name: str, own: Path, prefix: Path) -> None:
    file = Path(os.path.normpath(site / name))
    target = prefix / file.relative_to(own)
    if file.is_file() and not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        _link(str(file), str(target))


def _link(file: str, target: str) -> None:
    try:
        os.link(file, target)
    except OSError:
        shutil.copy2(file, target)
