"""A temporary ament prefix that makes source-only packages look built and sourced.

Everything that looks packages up (launch's `Node`, `FindPackageShare`, `ament_index_python`, the real `ros2`) finds
them there. Built packages take precedence: only what no prefix has is added, at the end of AMENT_PREFIX_PATH.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator, Mapping, MutableMapping
from pathlib import Path

from tutor.bundled_ros.ros2 import sources
from tutor.bundled_ros.ros2.sources import SourcePackage
from tutor.ros.prefixes import PACKAGE_INDEX, ament_prefixes, entries, holds_package, join_entries

_DEMO = Path(__file__).resolve().parents[1] / "demo"
_MODULES = Path("lib") / "python3" / "site-packages"
_DEMO_PACKAGES = ("demo_nodes_cpp", "demo_nodes_py")

_PACKAGE_SCRIPT = """\
#!{python} -P
import importlib
import sys
import types

name, folders = {name!r}, {folders!r}
if len(folders) == 1:
    sys.path.insert(0, folders[0].rpartition("/")[0])
else:
    package = types.ModuleType(name)
    package.__path__ = folders
    sys.modules[name] = package
    sys.path.append(folders[0])
module, _, function = {target!r}.partition(":")
program = importlib.import_module(name + "." + module)
for part in function.split("."):
    program = getattr(program, part)
sys.exit(program())
"""

_DEMO_SCRIPT = """\
#!{python} -P
import runpy
import sys

sys.argv[1:1] = [{name!r}, {program!r}]
runpy.run_path({nodes!r}, run_name="__main__")
"""

_ROS2_SCRIPT = """\
#!{python} -P
import sys

from tutor.bundled_ros.ros2.command import main

sys.exit(main(sys.argv[1:]))
"""


def make_overlay(
    prefix: Path, near: Path | None, environ: MutableMapping[str, str], *, python: str = sys.executable
) -> None:
    """Create the folder `prefix`, which must not exist yet, and change `environ` so that it is used.

    `near` is the launch file (or folder) whose workspace's packages are added; outside any workspace, the modules
    beside the launch file become part of `my_package`. `python` is the interpreter that runs the programs. If PATH has
    no `ros2`, the prefix gets ours.
    """
    prefixes = ament_prefixes(environ)
    added: set[str] = set()
    for package in _source_packages(near, environ):
        if package.name in added or any(holds_package(ament_prefix, package.name) for ament_prefix in prefixes):
            continue
        if package.name in _DEMO_PACKAGES and not package.programs:
            continue  # its C++ programs are not built; ours do the same
        added.add(package.name)
        for program, target in package.programs.items():
            folders = [str(folder) for folder in package.modules]
            script = _PACKAGE_SCRIPT.format(python=python, name=package.name, folders=folders, target=target)
            _write_program(prefix / "lib" / package.name / program, script)
        _add_package(prefix, package.name, package.share)
        if len(package.modules) > 1:
            _add_modules(prefix / _MODULES, package)
            _append(environ, "PYTHONPATH", prefix / _MODULES)
        elif (package.modules[0] / "__init__.py").is_file():
            _append(environ, "PYTHONPATH", package.modules[0].parent)
    for name in _DEMO_PACKAGES:
        if name not in added and not any(holds_package(ament_prefix, name) for ament_prefix in prefixes):
            for program in ("talker", "listener"):
                script = _DEMO_SCRIPT.format(python=python, name=name, program=program, nodes=str(_DEMO / "nodes.py"))
                _write_program(prefix / "lib" / name / program, script)
            share = _DEMO / "share" / name
            _add_package(prefix, name, {entry.name: entry for entry in share.iterdir()} if share.is_dir() else {})
    if shutil.which("ros2", path=environ.get("PATH", "")) is None:
        _write_program(prefix / "bin" / "ros2", _ROS2_SCRIPT.format(python=python))
        _append(environ, "PATH", prefix / "bin")
    _append(environ, "AMENT_PREFIX_PATH", prefix)


def _source_packages(near: Path | None, environ: Mapping[str, str]) -> Iterator[SourcePackage]:
    """Yield all source-only packages; of two with the same name, the first wins."""
    in_workspace = list(sources.workspace_packages(near)) if near is not None else []
    yield from in_workspace
    if (
        near is not None
        and near.is_file()
        and not any(package.name == sources.TEMPLATE.name for package in in_workspace)
    ):
        yield sources.package_with(near.parent)
    workspace = _find_workspace(environ)
    if workspace.is_dir():
        yield from sources.packages_below(workspace)
    yield sources.template_package()


def _find_workspace(environ: Mapping[str, str]) -> Path:
    if named := environ.get("ROS_TUTOR_WORKSPACE"):
        return Path(named).expanduser()
    from tutor.workspace import find_workspace  # late: most launch files are in a workspace or beside their modules

    return find_workspace()


def _add_package(prefix: Path, name: str, share: Mapping[str, Path]) -> None:
    folder = prefix / "share" / name
    folder.mkdir(parents=True)
    for entry, target in share.items():
        (folder / entry).symlink_to(target)
    marker = prefix / PACKAGE_INDEX / name
    marker.parent.mkdir(parents=True, exist_ok=True)
    marker.touch()


def _add_modules(folder: Path, package: SourcePackage) -> None:
    """Make a package whose modules are in several folders importable by its name."""
    init = folder / package.name / "__init__.py"
    init.parent.mkdir(parents=True, exist_ok=True)
    init.write_text(f"__path__ = {[str(module_folder) for module_folder in package.modules]!r}\n", encoding="utf-8")


def _write_program(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)


def _append(environ: MutableMapping[str, str], name: str, entry: Path) -> None:
    environ[name] = join_entries([*entries(environ, name), entry])
