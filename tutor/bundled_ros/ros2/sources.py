"""Source-only packages: the learner's own and the ones that come with the tutorial."""

from __future__ import annotations

import ast
import configparser
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

TEMPLATE = Path(__file__).resolve().parents[2] / "workspace" / "template" / "src" / "my_package"
_WORKSPACE_MARKER = ".ros-tutor"
_RUN_SETUP_TIMEOUT_S = 10.0
_MAX_DEPTH = 5  # levels searched in a workspace
_MAX_DEPTH_ELSEWHERE = 2
_MAX_FOLDERS = 2000
_SKIPPED = frozenset({"build", "install", "log", "node_modules", "venv"})
_IGNORE_MARKERS = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")

# Prints the console scripts that setup.py passes to setup(), as JSON, for a setup.py that cannot be parsed statically.
_CAPTURE_SCRIPT = """
import json, sys, types
caught = {}
stub = types.ModuleType("setuptools")
stub.setup = lambda **options: caught.update(options)
stub.find_packages = lambda *args, **options: []
sys.modules["setuptools"] = sys.modules["distutils.core"] = stub
sys.path.insert(0, "")
exec(compile(open("setup.py").read(), "setup.py", "exec"), {"__name__": "__main__", "__file__": "setup.py"})
print(json.dumps((caught.get("entry_points") or {}).get("console_scripts") or []))
"""


@dataclass(frozen=True, slots=True)
class SourcePackage:
    """A Python package of ROS nodes.

    `programs` maps each executable's name to `module:function`, with the module's name inside the Python package.
    `modules` are the folders of the Python package, in search order; `share` maps names to the entries of its share
    folder.
    """

    name: str
    programs: Mapping[str, str]
    modules: tuple[Path, ...]
    share: Mapping[str, Path]


def workspace_packages(place: Path) -> Iterator[SourcePackage]:
    """Yield the packages of the workspace around `place` (a file or folder), first the one that contains it."""
    folder = place if place.is_dir() else place.parent
    for parent in (folder, *folder.parents):
        if (parent / "package.xml").is_file():
            yield from _read_packages((parent, *_find_package_folders(_workspace_of(parent))))
            return
        if (parent / _WORKSPACE_MARKER).is_dir():
            yield from packages_below(parent)
            return
    yield from packages_below(folder)


def workspace_around(place: Path) -> Path | None:
    """Return the workspace that holds a file or folder: one of ours, else the folder above the `src` of its package."""
    for parent in place.parents:
        if (parent / _WORKSPACE_MARKER).is_dir():
            return parent
        if (parent / "package.xml").is_file() and (found := _workspace_of(parent)).name == "src":
            return found.parent
    return None


def import_roots(workspace: Path) -> Iterator[Path]:
    """Yield the folders from which the packages in a workspace are imported; no code of theirs is run or parsed."""
    for folder in _find_package_folders(workspace):
        if (folder / _package_name(folder) / "__init__.py").is_file():
            yield folder


def packages_below(folder: Path) -> Iterator[SourcePackage]:
    """Yield the packages in a workspace or any other folder."""
    yield from _read_packages(_find_package_folders(folder))


def _workspace_of(package: Path) -> Path:
    """Return the folder that holds a package and its neighbours: the nearest `src` above it, else its parent."""
    sources = next((parent for parent in package.parents if parent.name == "src"), None)
    return package.parent if sources is None else sources


def _find_package_folders(root: Path) -> Iterator[Path]:
    """Yield the package folders below a folder, as colcon does: at any depth, but none inside another package.

    Hidden folders, build output and folders with a COLCON_IGNORE file are skipped. A folder that is not a workspace
    may be huge, such as the home folder, so only `_MAX_DEPTH_ELSEWHERE` levels of it are searched.
    """
    level = [root]
    seen = 0
    is_workspace = root.name == "src" or (root / "src").is_dir() or (root / _WORKSPACE_MARKER).is_dir()
    for depth in range((_MAX_DEPTH if is_workspace else _MAX_DEPTH_ELSEWHERE) + 1):
        below: list[Path] = []
        for folder in level:
            if depth and (folder / "package.xml").is_file():
                yield folder
                continue
            seen += 1
            if seen <= _MAX_FOLDERS:
                below += _subfolders(folder)
        level = below


def _subfolders(folder: Path) -> list[Path]:
    try:
        names = [entry.name for entry in os.scandir(folder) if entry.is_dir()]
    except OSError:
        return []
    kept = (folder / name for name in sorted(names) if not name.startswith((".", "__")) and name not in _SKIPPED)
    return [path for path in kept if not any((path / marker).exists() for marker in _IGNORE_MARKERS)]


def package_with(folder: Path) -> SourcePackage:
    """Return `my_package` as if it held a folder's files; its modules take precedence over the template's."""
    programs = {**_modules_with_main(TEMPLATE / TEMPLATE.name), **_modules_with_main(folder)}
    share = {entry.name: entry for entry in folder.iterdir() if not entry.name.startswith((".", "__"))}
    for usual in ("launch", "config"):
        share.setdefault(usual, folder)
    return SourcePackage(TEMPLATE.name, programs, (folder, TEMPLATE / TEMPLATE.name), share)


def template_package() -> SourcePackage:
    """Return `my_package` as it is in a new workspace."""
    return _read_package(TEMPLATE)


def _read_packages(folders: Iterable[Path]) -> Iterator[SourcePackage]:
    for folder in dict.fromkeys(folders):
        yield _read_package(folder)


def _read_package(folder: Path) -> SourcePackage:
    name = _package_name(folder)
    programs = {
        program: target.removeprefix(f"{name}.")
        for program, target in _console_scripts(folder, name).items()
        if target.startswith(f"{name}.")
    }
    share = {entry.name: entry for entry in folder.iterdir() if not entry.name.startswith((".", "__"))}
    return SourcePackage(name, programs, (folder / name,), share)


def _package_name(folder: Path) -> str:
    found = re.search(r"<name>\s*([\w-]+)\s*</name>", (folder / "package.xml").read_text(encoding="utf-8"))
    return found[1] if found else folder.name


def _modules_with_main(folder: Path) -> dict[str, str]:
    """Map each module that has a main() to its entry point, like the setup.py of a new workspace."""
    return {
        module.stem: f"{module.stem}:main"
        for module in sorted(folder.glob("*.py"))
        if "def main(" in module.read_text(encoding="utf-8", errors="replace")
    }


def _console_scripts(folder: Path, name: str) -> dict[str, str]:
    setup = folder / "setup.py"
    entries: list[str] = []
    if setup.is_file():
        source = setup.read_bytes()
        if source == (TEMPLATE / "setup.py").read_bytes():
            return {program: f"{name}.{target}" for program, target in _modules_with_main(folder / name).items()}
        parsed = _parse_setup_py(source)
        entries = _run_setup_py(folder) if parsed is None else parsed
    if (folder / "setup.cfg").is_file() and not entries:
        entries = _read_setup_cfg(folder / "setup.cfg")
    pairs = (entry.partition("=") for entry in entries)
    return {program.strip(): target.strip() for program, sign, target in pairs if sign}


def _parse_setup_py(source: bytes) -> list[str] | None:
    """Return the console scripts of a setup.py without running it; None if they cannot be evaluated statically."""
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError):
        return []
    names = {
        target.id: node.value.value
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for call in (node for node in ast.walk(tree) if isinstance(node, ast.Call)):
        for keyword in call.keywords:
            if keyword.arg == "entry_points":
                try:
                    found = ast.literal_eval(_ConstantFolder(names).visit(keyword.value))
                    return [str(entry) for entry in found.get("console_scripts", [])]
                except (ValueError, TypeError, AttributeError):
                    return None
    return []


class _ConstantFolder(ast.NodeTransformer):
    """Folds constants: names of known constants, and f-strings and sums of constants."""

    def __init__(self, names: Mapping[str, Any]) -> None:
        self._names = names

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return ast.Constant(self._names[node.id]) if node.id in self._names else node

    def visit_JoinedStr(self, node: ast.JoinedStr) -> ast.expr:
        parts = [self.visit(part.value if isinstance(part, ast.FormattedValue) else part) for part in node.values]
        if not all(isinstance(part, ast.Constant) for part in parts):
            return node
        return ast.Constant("".join(str(part.value) for part in parts))

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        left, right = self.visit(node.left), self.visit(node.right)
        is_constant = (
            isinstance(left, ast.Constant) and isinstance(right, ast.Constant) and isinstance(node.op, ast.Add)
        )
        return ast.Constant(f"{left.value}{right.value}") if is_constant else node


def _run_setup_py(folder: Path) -> list[str]:
    try:
        done = subprocess.run(
            [sys.executable, "-c", _CAPTURE_SCRIPT],
            cwd=folder,
            capture_output=True,
            timeout=_RUN_SETUP_TIMEOUT_S,
            check=True,
        )
        entries = json.loads(done.stdout.splitlines()[-1])
        return [str(entry) for entry in entries]
    except (OSError, subprocess.SubprocessError, ValueError, IndexError, TypeError):
        return []


def _read_setup_cfg(path: Path) -> list[str]:
    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read(path, encoding="utf-8")
    except (configparser.Error, UnicodeDecodeError):
        return []
    return parser.get("options.entry_points", "console_scripts", fallback="").splitlines()
