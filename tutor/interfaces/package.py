"""The interface packages of a workspace: found as colcon finds them, read, and checked for what its build refuses."""

from __future__ import annotations

import difflib
import os
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor.interfaces import definitions
from tutor.interfaces.cmake_lists import GENERATE, CMakeLists, read_cmake_lists
from tutor.interfaces.problem import Problem
from tutor.ros.prefixes import INTERFACE_INDEX
from tutor.workspace.regular import read_regular

MAX_DEPTH = 5
_SKIPPED = frozenset({"build", "install", "log", "node_modules", "venv"})
_IGNORE_MARKERS = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
_NAME = re.compile(r"[a-z](?:_?[a-z0-9]){0,99}")
_MAX_BYTES = 32_000
_GROUP = "rosidl_interface_packages"
_GENERATORS = "rosidl_default_generators"
_BUILD_DEPENDS = ("depend", "build_depend", "buildtool_depend")
IMPLIED = {
    "msg": (),
    "srv": ("service_msgs", "builtin_interfaces"),
    "action": ("action_msgs", "service_msgs", "builtin_interfaces", "unique_identifier_msgs"),
}
"""Packages that the code generated for a kind of file uses, whether the file does or not."""


@dataclass(frozen=True, slots=True)
class InterfacePackage:
    """A package that calls `rosidl_generate_interfaces`, or has files of that kind.

    `name` is the one in package.xml (`declared`), or if that cannot be one, another by which it can be told of.
    `files` are those to build, relative to `folder`; `unlisted` those that its CMakeLists.txt does not name.
    `build_depends` are the packages that its package.xml names as needed for the build.
    """

    name: str
    declared: str
    folder: Path
    cmake: CMakeLists
    files: tuple[str, ...]
    unlisted: tuple[str, ...]
    build_type: str
    is_member_of_group: bool
    build_depends: tuple[str, ...] = ()

    @property
    def dependencies(self) -> tuple[str, ...]:
        """The packages whose types this one may use, without those that come with its kinds of files."""
        return self.cmake.dependencies

    def is_in_place(self, file: str) -> bool:
        """Whether a listed file is in the folder of its kind, in this package."""
        kind = Path(file).suffix[1:]
        return kind in definitions.KINDS and Path(file).parent == Path(kind)

    @property
    def generated_with(self) -> tuple[str, ...]:
        """The packages that the generated code uses in any case."""
        kinds = dict.fromkeys(Path(file).suffix[1:] for file in self.files)
        return tuple(dict.fromkeys(name for kind in kinds for name in IMPLIED.get(kind, ())))


@dataclass(frozen=True, slots=True)
class KnownTypes:
    """The message types that a package can use: those of its own files, and those in other packages.

    `shares` are the share folders of the installed and built packages, by name, and `neighbours` the other interface
    packages of the workspace.
    """

    package: InterfacePackage
    shares: Mapping[str, Path]
    neighbours: Sequence[str]

    def why_not(self, owner: str, name: str) -> str:
        """Return why a field cannot have this type; empty if it can."""
        package = self.package
        if owner in ("", package.name):
            own = [Path(file).stem for file in package.files if file.endswith(".msg")]
            if name in own:
                return ""
            if f"msg/{name}.msg" in package.unlisted:
                return f"msg/{name}.msg is not listed in {GENERATE}() of CMakeLists.txt"
            near = difflib.get_close_matches(name, own, n=1)
            elsewhere = [other for other, share in self.shares.items() if (share / "msg" / f"{name}.msg").is_file()]
            guess = near[0] if near else f"{elsewhere[0]}/{name}" if elsewhere else ""
            return f"{package.name} has no msg/{name}.msg" + (f"; is it {guess}?" if guess else "")
        if owner not in self.shares:
            if owner in self.neighbours:
                return "" if owner in package.dependencies else _not_a_dependency(owner)
            near = difflib.get_close_matches(owner, [*self.shares, *self.neighbours], n=1)
            return f"there is no package {owner}" + (f"; is it {near[0]}?" if near else "")
        folder = self.shares[owner] / "msg"
        if not (folder / f"{name}.idl").is_file():
            near = difflib.get_close_matches(name, [path.stem for path in folder.glob("*.msg")], n=1)
            return f"{owner} has no message {name}" + (f"; is it {owner}/{near[0]}?" if near else "")
        return "" if owner in package.dependencies else _not_a_dependency(owner)


def _not_a_dependency(owner: str) -> str:
    return f"a type of {owner} needs DEPENDENCIES {owner} in {GENERATE}() of CMakeLists.txt"


def find_packages(root: Path, depth: int = MAX_DEPTH) -> list[InterfacePackage]:
    """Return the interface packages below a workspace's folder, by name; of two with one name, the first.

    Like colcon: at any depth, none inside another package, none where a COLCON_IGNORE file lies.
    """
    found: dict[str, InterfacePackage] = {}
    for folder in _package_folders(root, depth):
        try:
            package = _read(folder)
        except (OSError, ElementTree.ParseError):
            continue
        if package is not None:
            found.setdefault(package.name, package)
    return [found[name] for name in sorted(found)]


def problems_of(package: InterfacePackage, types: KnownTypes) -> Iterator[Problem]:
    """Yield what keeps a package from being built, here or by colcon: the package first, then its files' lines."""
    yield from _of_the_package(package)
    cmake = package.folder / "CMakeLists.txt"
    for name in package.dependencies:
        if name not in types.shares and name not in types.neighbours:
            near = difflib.get_close_matches(name, [*types.shares, *types.neighbours], n=1)
            guess = f"; is it {near[0]}?" if near else ""
            yield Problem(
                cmake, package.cmake.line, f"there is no interface package {name}, named after DEPENDENCIES{guess}"
            )
    for file in package.files:
        path = package.folder / file
        if package.is_in_place(file) and path.is_file():
            yield from definitions.problems_of(package.name, path, types.why_not)


def _of_the_package(package: InterfacePackage) -> Iterator[Problem]:
    manifest, cmake = package.folder / "package.xml", package.folder / "CMakeLists.txt"
    if package.declared != package.name:
        says = f"the name of an interface package is in lower_snake_case, and {package.declared!r} is not"
        yield Problem(manifest, None, says)
        return
    if package.build_type != "ament_cmake":
        where = ", ".join([*package.files, *package.unlisted])
        yield Problem(
            manifest,
            None,
            f"a package of type {package.build_type} cannot build interfaces ({where}):"
            " they need a package of their own, made with ros2 pkg create --build-type ament_cmake",
        )
        return
    if package.cmake.line is None:
        yield Problem(cmake, None, f"{GENERATE}() is not called, so nothing is made of {', '.join(package.unlisted)}")
        return
    line = package.cmake.line
    if package.cmake.project != package.name:
        wrong = package.cmake.project or "none"
        yield Problem(cmake, None, f"project() must name the package, {package.name}, and names {wrong}")
    found = (*package.cmake.found, *(package.build_depends if package.cmake.finds_build_depends else ()))
    for name in dict.fromkeys((_GENERATORS, *package.dependencies)):
        if name not in found:
            yield Problem(cmake, line, f"{GENERATE}() needs find_package({name} REQUIRED) before it")
    if not package.is_member_of_group:
        yield Problem(manifest, None, f"an interface package needs <member_of_group>{_GROUP}</member_of_group>")
    if not package.files:
        yield Problem(cmake, line, f"{GENERATE}() names no .msg, .srv or .action file")
    for file in package.files:
        path = package.folder / file
        kind = path.suffix[1:]
        if kind not in definitions.KINDS:
            yield Problem(cmake, line, f"{file} is no .msg, .srv or .action file")
        elif Path(file).parent != Path(kind):
            yield Problem(cmake, line, f"{file} must lie in the folder {kind}, as {kind}/{path.name}")
        elif not path.is_file():
            near = difflib.get_close_matches(file, package.unlisted, n=1)
            yield Problem(
                cmake, line, f"{file} is listed, and there is no such file" + (f"; is it {near[0]}?" if near else "")
            )


def _read(folder: Path) -> InterfacePackage | None:
    """Return the package in a folder; None if it has to do with no interfaces."""
    present = tuple(
        path.relative_to(folder).as_posix()
        for kind in definitions.KINDS
        for path in sorted((folder / kind).glob(f"*.{kind}"))
    )
    text = _text_of(folder / "CMakeLists.txt")
    if not present and GENERATE not in text:
        return None
    cmake = read_cmake_lists(text)
    manifest = ElementTree.fromstring(_text_of(folder / "package.xml"))
    declared = (manifest.findtext("name") or folder.name).strip()
    name = next((text for text in (declared, folder.name) if _NAME.fullmatch(text)), "unnamed")
    build_type = (manifest.findtext("export/build_type") or "ament_cmake").strip()
    member = any((group.text or "").strip() == _GROUP for group in manifest.iter("member_of_group"))
    files = present if cmake.files is None else cmake.files
    unlisted = tuple(file for file in present if file not in files)
    depends = tuple((element.text or "").strip() for tag in _BUILD_DEPENDS for element in manifest.iter(tag))
    return InterfacePackage(name, declared, folder, cmake, files, unlisted, build_type, member, depends)


def _text_of(path: Path) -> str:
    """Return the text of a file; empty if there is none, or one that is too large."""
    content = read_regular(path, _MAX_BYTES) if path.is_file() else None
    return (content or b"").decode("utf-8", "replace")


def _package_folders(root: Path, depth: int) -> Iterator[Path]:
    level = [root]
    for _ in range(depth + 1):
        below: list[Path] = []
        for folder in level:
            if folder != root and (folder / "package.xml").is_file():
                yield folder
                continue
            below += _subfolders(folder)
        level = below


def _subfolders(folder: Path) -> list[Path]:
    try:
        names = sorted(entry.name for entry in os.scandir(folder) if entry.is_dir())
    except OSError:
        return []
    kept = (folder / name for name in names if not name.startswith((".", "__")) and name not in _SKIPPED)
    return [path for path in kept if not any((path / marker).exists() for marker in _IGNORE_MARKERS)]


def installed_shares(prefixes: Sequence[Path]) -> dict[str, Path]:
    """Map each interface package of some ament prefixes to its share folder; the first prefix wins."""
    shares: dict[str, Path] = {}
    for prefix in prefixes:
        for marker in sorted((prefix / INTERFACE_INDEX).glob("*")):
            shares.setdefault(marker.name, prefix / "share" / marker.name)
    return shares
