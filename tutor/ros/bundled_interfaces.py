"""The bundled `example_interfaces` (srv/AddTwoInts), built into an ament prefix in `bundled_ros`.

A process of its own gets at it through its environment: `PYTHONPATH` with `site_packages()`, `AMENT_PREFIX_PATH` with
`prefix()`, `LD_LIBRARY_PATH` with `library_dir()`. The running process gets at it with `activate()`.
A real `example_interfaces`, where there is one, always goes first.
"""

import ctypes
import importlib
import importlib.util
import os
import sys
from pathlib import Path

from tutor.errors import InterfacesNotBuiltError

_PACKAGE = "example_interfaces"


def prefix() -> Path:
    """The ament prefix that holds the bundled interfaces."""
    return Path(__file__).resolve().parent.parent / "bundled_ros" / "prefix"


def site_packages() -> Path:
    """The folder to put on `PYTHONPATH`."""
    return library_dir() / "python3.12" / "site-packages"


def library_dir() -> Path:
    """The folder to put on `LD_LIBRARY_PATH`."""
    return prefix() / "lib"


def activate() -> None:
    """Make `import example_interfaces` work in this process; nothing happens where it works already.

    The ROS wheels' own libraries must be loadable (their start-up hook sees to it). Raises
    `InterfacesNotBuiltError` where the prefix is missing, `OSError` where a library cannot be loaded.
    """
    if importlib.util.find_spec(_PACKAGE) is not None:
        return
    if not (site_packages() / _PACKAGE).is_dir():
        missing = site_packages() / _PACKAGE
        raise InterfacesNotBuiltError(
            f"the bundled {_PACKAGE} is not built ({missing} is missing);"
            " in a clone, ./.ci/uv sync --reinstall-package ros-tutor builds it"
        )
    # LD_LIBRARY_PATH is only read when a process starts. A library that is loaded already is found by its name alone,
    # which is how the ROS type supports look for one another.
    for library in sorted(library_dir().glob("*.so")):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    sys.path.append(str(site_packages()))
    importlib.invalidate_caches()
    known = [entry for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry]
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join([*known, str(prefix())])
