"""The bundled `example_interfaces`, built into an ament prefix in `bundled_ros`.

A child process finds it through its environment: `PYTHONPATH` with `site_packages()`, `AMENT_PREFIX_PATH` with
`prefix()`, `LD_LIBRARY_PATH` with `library_dir()`. The running process uses `activate()`.
A real `example_interfaces`, if installed, always takes precedence.
"""

import ctypes
import importlib
import importlib.util
import os
import sys
from pathlib import Path

from tutor.errors import InterfacesNotBuiltError

PYTHON = f"python{sys.version_info.major}.{sys.version_info.minor}"
"""The Python that runs us: what is compiled for another one cannot be imported."""

_PACKAGE = "example_interfaces"


def prefix() -> Path:
    """Return the ament prefix of the bundled interfaces."""
    return Path(__file__).resolve().parent.parent / "bundled_ros" / "prefix"


def site_packages() -> Path:
    """Return the folder to put on `PYTHONPATH`."""
    return library_dir() / PYTHON / "site-packages"


def library_dir() -> Path:
    """Return the folder to put on `LD_LIBRARY_PATH`."""
    return prefix() / "lib"


def startup_folder() -> Path:
    """Return the folder to put on `PYTHONPATH` whose `sitecustomize` repairs what does not work in the ROS wheels."""
    return Path(__file__).resolve().parent.parent / "bundled_ros" / "startup"


def activate() -> None:
    """Make `import example_interfaces` work in this process. Does nothing if it already does.

    The ROS wheels' own libraries must be loadable, which their start-up hook ensures. Raises
    `InterfacesNotBuiltError` if the prefix is missing, `OSError` if a library cannot be loaded.
    """
    if importlib.util.find_spec(_PACKAGE) is not None:
        return
    if not (site_packages() / _PACKAGE).is_dir():
        missing = site_packages() / _PACKAGE
        raise InterfacesNotBuiltError(
            f"the bundled {_PACKAGE} is not built ({missing} is missing);"
            " in a clone, ./.ci/uv sync --reinstall-package ros-tutor builds it"
        )
    # LD_LIBRARY_PATH is only read when a process starts. Once a library is loaded, it is found by name alone, which is
    # how the ROS type supports look for one another.
    for library in sorted(library_dir().glob("*.so")):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    sys.path.append(str(site_packages()))
    importlib.invalidate_caches()
    known = [entry for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry]
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join([*known, str(prefix())])
