"""Builds the interface packages of a workspace, as far as they have changed, into the user's cache folder."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from tutor import __version__
from tutor.interfaces import build_cache, compiling
from tutor.interfaces.compiling import CompileError, Job, Python, compile_package, run_to_end
from tutor.interfaces.definitions import MAX_BYTES
from tutor.interfaces.package import (
    MAX_DEPTH,
    InterfacePackage,
    KnownTypes,
    find_packages,
    installed_shares,
    problems_of,
)
from tutor.interfaces.problem import Problem
from tutor.interfaces.toolchain import Toolchain, find_toolchain
from tutor.ros import prefixes, workspace_interfaces
from tutor.ros.environment import RosEnvironment, tutor_env
from tutor.workspace.regular import read_regular

_GENERATOR = Path(__file__).with_name("generating.py")
_GENERATE_LIMIT_S = 120.0

Progress = Callable[[str, float], object]
"""Told the name of the package that is being built, and which fraction of it is done."""


@dataclass(frozen=True, slots=True)
class Build:
    """What became of one package: built into `prefix`, or not, for the reasons in `problems`."""

    package: InterfacePackage
    prefix: Path | None = None
    problems: tuple[Problem, ...] = ()

    @property
    def name(self) -> str:
        return self.package.name


@dataclass(slots=True)
class _Workspace:
    """What the packages that are still to be built can use."""

    ros: RosEnvironment
    packages: Mapping[str, InterfacePackage]
    prefixes: tuple[Path, ...]
    builds: dict[str, Build] = field(default_factory=dict)

    def shares(self) -> dict[str, Path]:
        installed = installed_shares(self.prefixes)
        for name in self.packages:
            installed.pop(name, None)  # the workspace's own takes precedence, even if it is not built
        own = {name: build.prefix / "share" / name for name, build in self.builds.items() if build.prefix}
        return {**installed, **own}


def build_workspace(
    root: Path, ros: RosEnvironment, progress: Progress = lambda name, fraction: None, *, depth: int = MAX_DEPTH
) -> list[Build]:
    """Build the interface packages below a folder where needed; return what became of each, by name.

    What is built for a workspace is found by `tutor.ros.workspace_interfaces`, from then on. `depth`: how many levels
    of folders are searched. Raises OSError if the cache folder cannot be written to.
    """
    found = find_packages(root, depth)
    if not found:
        with suppress(OSError):
            _link(root, [])
        return []
    environment = tutor_env(ros, isolated=False)
    ament = tuple(path for path in prefixes.ament_prefixes(environment) if not workspace_interfaces.is_built(path))
    workspace = _Workspace(ros, {package.name: package for package in found}, ament)
    for package in _in_order(workspace.packages):
        workspace.builds[package.name] = _build(package, workspace, environment, progress)
    builds = [workspace.builds[package.name] for package in found]
    _link(root, builds)
    return builds


def _in_order(packages: Mapping[str, InterfacePackage]) -> Iterator[InterfacePackage]:
    """Yield the packages, each after those that it depends on."""
    done: set[str] = set()

    def visit(name: str, path: tuple[str, ...]) -> Iterator[InterfacePackage]:
        if name in done or name in path:
            return
        for dependency in packages[name].dependencies:
            if dependency in packages:
                yield from visit(dependency, (*path, name))
        done.add(name)
        yield packages[name]

    for name in packages:
        yield from visit(name, ())


def _build(
    package: InterfacePackage, workspace: _Workspace, environment: Mapping[str, str], progress: Progress
) -> Build:
    own = {name: workspace.builds[name].prefix for name in package.dependencies if name in workspace.builds}
    used = tuple(path for path in own.values() if path is not None)
    digest = _digest(package, workspace, used) if len(used) == len(own) else ""
    prefix = build_cache.place(package.name, digest)
    if digest and build_cache.is_complete(prefix):
        build_cache.note_use(prefix)
        return Build(package, prefix)
    shares = workspace.shares()
    problems = tuple(problems_of(package, KnownTypes(package, shares, tuple(workspace.packages))))
    if not problems and len(used) < len(own):
        failed = next(name for name, path in own.items() if path is None)
        problems = (Problem(package.folder, None, f"it uses {failed}, which is not built"),)
    if problems:
        return Build(package, problems=problems)
    tools = find_toolchain()
    if isinstance(tools, str):
        return Build(package, problems=(Problem(package.folder, None, tools),))
    prefix.parent.mkdir(parents=True, exist_ok=True)
    with build_cache.locked(prefix):
        if not build_cache.is_complete(prefix):
            progress(package.name, 0.0)
            try:
                _make(package, workspace, environment, prefix, used, shares, tools, progress)
            except CompileError as error:
                return Build(package, problems=(Problem(package.folder, None, f"it cannot be compiled: {error}"),))
            progress(package.name, 1.0)
            build_cache.remove_unused()
    return Build(package, prefix)


def _make(
    package: InterfacePackage,
    workspace: _Workspace,
    environment: Mapping[str, str],
    prefix: Path,
    used: Sequence[Path],
    shares: Mapping[str, Path],
    tools: Toolchain,
    progress: Progress,
) -> None:
    """Make a package's prefix beside its place, and move it there. Raises CompileError and OSError."""
    dependencies = _all_dependencies(package, workspace)
    with tempfile.TemporaryDirectory(prefix=".building-", dir=prefix.parent) as scratch_name:
        scratch = Path(scratch_name)
        made = scratch / "prefix"
        share, sources = made / "share" / package.name, made / "include" / package.name
        introspection = scratch / "introspection" / package.name
        python = made / workspace_interfaces.SITE_PACKAGES / package.name
        arguments = {
            "package": package.name,
            "folder": str(package.folder),
            "files": list(package.files),
            "share": str(share),
            "sources": str(sources),
            "introspection": str(introspection),
            "python": str(python),
            "scratch": str(scratch),
            "dependencies": {name: str(shares[name]) for name in dependencies if name in shares},
        }
        found = _generate(arguments, workspace.ros, environment, scratch)
        progress(package.name, 0.4)
        job = Job(
            package.name,
            (sources, introspection),
            python,
            scratch,
            made / "lib",
            workspace.prefixes,
            tuple(used),
            dependencies,
        )
        compile_package(job, tools, found, lambda fraction: progress(package.name, 0.4 + 0.6 * fraction))
        shutil.copytree(introspection, sources, ignore=shutil.ignore_patterns("*.c"), dirs_exist_ok=True)
        for leftover in (*sources.rglob("*.c"), *sources.rglob("*.cpp"), *python.rglob("*.c")):
            leftover.unlink()
        _write_index(package, made, dependencies)
        shutil.copy2(package.folder / "package.xml", share / "package.xml")
        made.chmod(0o755)
        build_cache.put(made, prefix)


def _generate(
    arguments: Mapping[str, object], ros: RosEnvironment, environment: Mapping[str, str], scratch: Path
) -> Python:
    """Run the generators in the Python of the ROS in use. Raises CompileError."""
    given = scratch / "arguments.json"
    given.write_text(json.dumps(arguments), encoding="utf-8")
    command = [str(ros.python), "-P", str(_GENERATOR), str(given)]
    ended = run_to_end(command, _GENERATE_LIMIT_S, environment)
    if ended.returncode:
        raise CompileError((ended.stderr.strip().splitlines() or ["the generators failed"])[-1])
    answer = json.loads(ended.stdout)
    return Python(tuple(answer["includes"]), answer["suffix"])


def _all_dependencies(package: InterfacePackage, workspace: _Workspace) -> tuple[str, ...]:
    """Return the packages whose types the generated code may use: those named, and those that these use in turn."""
    index = prefixes.indexed(prefixes.INTERFACE_INDEX, workspace.prefixes)
    found: dict[str, None] = {}
    waiting = [*package.dependencies, *package.generated_with]
    while waiting:
        name = waiting.pop(0)
        if name in found or name == package.name:
            continue
        found[name] = None
        if name in workspace.packages:
            other = workspace.packages[name]
            waiting += [*other.dependencies, *other.generated_with]
        elif name in index:
            listed = index[name] / prefixes.PACKAGE_INDEX.parent / "package_run_dependencies" / name
            with suppress(OSError):
                waiting += [other for other in listed.read_text(encoding="utf-8").split(";") if other in index]
    return tuple(found)


def _write_index(package: InterfacePackage, prefix: Path, dependencies: Sequence[str]) -> None:
    """Write the entries of the ament index that an installed interface package has."""
    files = [name for file in package.files for name in (str(Path(file).with_suffix(".idl")), file)]
    for index, text in (
        (prefixes.PACKAGE_INDEX, ""),
        (prefixes.INTERFACE_INDEX, "\n".join(files)),
        (prefixes.PACKAGE_INDEX.parent / "package_run_dependencies", ";".join(dependencies)),
    ):
        path = prefix / index / package.name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def _digest(package: InterfacePackage, workspace: _Workspace, used: Sequence[Path]) -> str:
    """Return what changes with whatever the built files depend on; empty if a file cannot be read."""
    digest = sha256()
    first = (__version__, workspace.ros.python, workspace.ros.kind, workspace.ros.distro)
    for part in (*first, *workspace.prefixes, *(path.name for path in used), package.name):
        digest.update(f"{part}\0".encode())
    if not all(map(package.is_in_place, package.files)):
        return ""
    names = ("package.xml", "CMakeLists.txt", *package.files)
    try:
        for path in (_GENERATOR, Path(compiling.__file__), *(package.folder / name for name in names)):
            content = read_regular(path, MAX_BYTES)
            if content is None:
                return ""
            digest.update(path.name.encode() + b"\0" + content + b"\0")
    except OSError:
        return ""
    return digest.hexdigest()[:16]


def _link(root: Path, builds: Sequence[Build]) -> None:
    """Make the links of a workspace lead to what is built of it now. In place of one that failed is the reason.

    Nothing older is left of it: a type that is not what its file says would mislead.
    """
    folder = workspace_interfaces.links_folder(root)
    if not builds and not folder.is_dir():
        return
    folder.mkdir(parents=True, exist_ok=True)
    for link in folder.iterdir():
        if not link.name.startswith(".") and link.name.partition(".")[0] not in [build.name for build in builds]:
            link.unlink(missing_ok=True)
    for build in builds:
        link = folder / build.name
        reason = folder / f"{build.name}.unbuilt"
        if build.prefix is None:
            link.unlink(missing_ok=True)
            reason.write_text(build.problems[0].text(root), encoding="utf-8")
            continue
        reason.unlink(missing_ok=True)
        if not link.is_symlink() or Path(os.readlink(link)) != build.prefix:
            temporary = folder / f".{build.name}.{os.getpid()}"
            temporary.unlink(missing_ok=True)
            temporary.symlink_to(build.prefix)
            temporary.replace(link)
