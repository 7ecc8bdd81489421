"""The message types that a check needs: those a learner has defined, for their node, and the exercise's own, for us."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from tutor.bundled_ros.ros2 import sources
from tutor.content import Lesson
from tutor.engine import loading
from tutor.engine.environment import package_folder
from tutor.errors import EngineError
from tutor.interfaces import Build, build_workspace
from tutor.interfaces.definitions import definition_of
from tutor.interfaces.package import MAX_DEPTH
from tutor.judge.interface_build import Definition, InterfaceBuild
from tutor.ros import workspace_interfaces
from tutor.ros.environment import RosEnvironment

Say = Callable[[str], object]


def build_beside(path: Path, ros: RosEnvironment, say: Say = lambda text: None) -> list[Build]:
    """Build the interface packages of the workspace that a learner's file is in, or of the folder it was handed in.

    `say` is told what is being done. Raises EngineError.
    """
    root, depth = _place_of(path)
    return _build(root, ros, say, depth)


def use_own(lesson: Lesson, ros: RosEnvironment, say: Say = lambda text: None) -> None:
    """Make this process, which observes, know the types that the exercise's own solution defines.

    It never loads a learner's: they may have other fields, and one process can have only one type of a name. Raises
    EngineError.
    """
    folder = lesson.folder / "solution"
    for build in _build(folder, ros, say, 1):
        if build.prefix is None:
            raise EngineError(build.problems[0].reason)
        try:
            with loading.changes_trusted():
                workspace_interfaces.activate(build.prefix, build.name)
        except (ImportError, OSError) as error:
            raise EngineError(f"the types of {build.name} cannot be loaded: {error}") from error


def seen_builds(builds: Sequence[Build], root: Path) -> tuple[InterfaceBuild, ...]:
    """Return the builds as a check sees them; the paths in their reasons are relative to `root`."""
    return tuple(
        InterfaceBuild(
            build.name,
            _definitions_of(build),
            tuple(problem.text(root) for problem in build.problems),
            build.package.unlisted,
        )
        for build in builds
    )


def _definitions_of(build: Build) -> dict[str, Definition]:
    """Return the fields of each type, from what was built: the learner's files may have changed since then."""
    if build.prefix is None:
        return {}
    share = build.prefix / "share" / build.name
    return {str(Path(file).with_suffix("")): definition_of(share / file) for file in build.package.files}


def _place_of(path: Path) -> tuple[Path, int]:
    """Return the folder to search for packages, and how deep. One that is no workspace may be huge: a home folder."""
    if (workspace := sources.workspace_around(path)) is not None:
        return workspace, MAX_DEPTH
    folder = package_folder(path)
    return (folder.parent if (folder / "package.xml").is_file() else folder), 1


def root_of(path: Path) -> Path:
    """Return the folder whose interface packages belong to a learner's file."""
    return _place_of(path)[0]


def _build(root: Path, ros: RosEnvironment, say: Say, depth: int) -> list[Build]:
    try:
        return build_workspace(root, ros, lambda name, done: say(f"building {name}, {done:.0%}"), depth=depth)
    except OSError as error:
        raise EngineError(f"message types cannot be built: {error}") from error
