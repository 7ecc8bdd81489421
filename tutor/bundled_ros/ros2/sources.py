"""Packages that are there as sources only: the learner's own, and those that we bring."""

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
_MARKER = ".ros-tutor"
_RUN_SETUP_S = 10.0
_DEEPEST = 5
_NEAR = 2
_MOST = 2000
_BUILT = frozenset({"build", "install", "log", "node_modules", "venv"})
_IGNORED = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")

# Gives what setup.py passes to setup(), as JSON, where that cannot be read off.
_CAPTURE = """
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

    `programs` maps the name of each to `module:function` (the module within the Python package). `modules` are the
    folders of the Python package, searched in this order; `share` maps names to what its share folder has.
    """

    name: str
    programs: Mapping[str, str]
    modules: tuple[Path, ...]
    share: Mapping[str, Path]


def workspace_packages(place: Path) -> Iterator[SourcePackage]:
    """The packages of the workspace that `place` (a file or folder) is in, its own package first."""
    folder = place if place.is_dir() else place.parent
    for parent in (folder, *folder.parents):
        if (parent / "package.xml").is_file():
            yield from _packages((parent, *_folders(_workspace_of(parent))))
            return
        if (parent / _MARKER).is_dir():
            yield from packages_below(parent)
            return
    yield from packages_below(folder)


def packages_below(folder: Path) -> Iterator[SourcePackage]:
    """The packages in a workspace, or in a folder."""
    yield from _packages(_folders(folder))


def _workspace_of(package: Path) -> Path:
    """Where the packages beside one are: below the nearest folder `src` around it, else in the folder that it is in."""
    sources = next((parent for parent in package.parents if parent.name == "src"), None)
    return package.parent if sources is None else sources


def _folders(root: Path) -> Iterator[Path]:
    """The folders of packages in a folder, as colcon finds them: at any depth, but none within another.

    What is hidden, built or has a file COLCON_IGNORE is left out. A folder that is not a workspace may be large, such
    as the home folder: it is searched `_NEAR` levels deep.
    """
    level = [root]
    seen = 0
    is_workspace = root.name == "src" or (root / "src").is_dir() or (root / _MARKER).is_dir()
    for depth in range((_DEEPEST if is_workspace else _NEAR) + 1):
        below: list[Path] = []
        for folder in level:
            if depth and (folder / "package.xml").is_file():
                yield folder
                continue
            seen += 1
            if seen <= _MOST:
                below += _subfolders(folder)
        level = below


def _subfolders(folder: Path) -> list[Path]:
    try:
        names = [entry.name for entry in os.scandir(folder) if entry.is_dir()]
    except OSError:
        return []
    kept = (folder / name for name in sorted(names) if not name.startswith((".", "__")) and name not in _BUILT)
    return [path for path in kept if not any((path / marker).exists() for marker in _IGNORED)]


def package_with(folder: Path) -> SourcePackage:
    """`my_package` as it would be with the files of a folder in it: its modules go before those of the template."""
    programs = {**_with_main(TEMPLATE / TEMPLATE.name), **_with_main(folder)}
    share = {entry.name: entry for entry in folder.iterdir() if not entry.name.startswith((".", "__"))}
    for usual in ("launch", "config"):
        share.setdefault(usual, folder)
    return SourcePackage(TEMPLATE.name, programs, (folder, TEMPLATE / TEMPLATE.name), share)


def template_package() -> SourcePackage:
    """`my_package` as a new workspace has it."""
    return _package(TEMPLATE)


def _packages(folders: Iterable[Path]) -> Iterator[SourcePackage]:
    for folder in dict.fromkeys(folders):
        yield _package(folder)


def _package(folder: Path) -> SourcePackage:
    found = re.search(r"<name>\s*([\w-]+)\s*</name>", (folder / "package.xml").read_text(encoding="utf-8"))
    name = found[1] if found else folder.name
    programs = {
        program: target.removeprefix(f"{name}.")
        for program, target in _console_scripts(folder, name).items()
        if target.startswith(f"{name}.")
    }
    share = {entry.name: entry for entry in folder.iterdir() if not entry.name.startswith((".", "__"))}
    return SourcePackage(name, programs, (folder / name,), share)


def _with_main(folder: Path) -> dict[str, str]:
    """The modules that have a main(), as the setup.py of a new workspace makes programs of them."""
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
            return {program: f"{name}.{target}" for program, target in _with_main(folder / name).items()}
        read = _read_off(source)
        entries = _run_setup(folder) if read is None else read
    if (folder / "setup.cfg").is_file() and not entries:
        entries = _of_setup_cfg(folder / "setup.cfg")
    pairs = (entry.partition("=") for entry in entries)
    return {program.strip(): target.strip() for program, sign, target in pairs if sign}


def _read_off(source: bytes) -> list[str] | None:
    """The console scripts of a setup.py, without running it; None where they are not written down plainly."""
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
                    found = ast.literal_eval(_Plain(names).visit(keyword.value))
                    return [str(entry) for entry in found.get("console_scripts", [])]
                except (ValueError, TypeError, AttributeError):
                    return None
    return []


class _Plain(ast.NodeTransformer):
    """Puts in what is known: f-strings and sums of plain texts, and names of such."""

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
        plain = isinstance(left, ast.Constant) and isinstance(right, ast.Constant) and isinstance(node.op, ast.Add)
        return ast.Constant(f"{left.value}{right.value}") if plain else node


def _run_setup(folder: Path) -> list[str]:
    try:
        ran = subprocess.run(
            [sys.executable, "-c", _CAPTURE], cwd=folder, capture_output=True, timeout=_RUN_SETUP_S, check=True
        )
        entries = json.loads(ran.stdout.splitlines()[-1])
        return [str(entry) for entry in entries]
    except (OSError, subprocess.SubprocessError, ValueError, IndexError, TypeError):
        return []


def _of_setup_cfg(path: Path) -> list[str]:
    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read(path, encoding="utf-8")
    except (configparser.Error, UnicodeDecodeError):
        return []
    return parser.get("options.entry_points", "console_scripts", fallback="").splitlines()
