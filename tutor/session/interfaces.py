"""The message types of a workspace as a long-running front end builds them: whenever a file of theirs has changed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

_Stamps = tuple[tuple[str, int, int], ...]
_NAMES = ("package.xml", "CMakeLists.txt")
_FOLDERS = ("msg", "srv", "action")


class InterfaceBuilds:
    """What is built of a workspace's message types. Its methods read the disk, and belong in a thread.

    `prefixes`: where they are; `problems`: a sentence for each package that is not built.
    """

    def __init__(self, workspace: Path) -> None:
        self._root = workspace
        self._stamps: _Stamps = ()
        self.prefixes: tuple[Path, ...] = ()
        self.problems: tuple[str, ...] = ()

    def have_changed(self) -> bool:
        """Whether a file that types are made of has changed since the last call."""
        stamps = self._read_stamps()
        changed = stamps != self._stamps
        self._stamps = stamps
        return changed

    def build(self, say: Callable[[str], object]) -> None:
        """Build what has changed; `say` is told what is being done, in a few words."""
        from tutor.interfaces import build_workspace  # late: most workspaces define no types
        from tutor.ros.environment import detect

        try:
            builds = build_workspace(self._root, detect(), lambda name, done: say(f"building {name} {done:.0%}"))
        except OSError as error:
            self.problems = (f"Message types cannot be built: {error.strerror or error}",)
            return
        self.prefixes = tuple(build.prefix for build in builds if build.prefix is not None)
        self.problems = tuple(
            f"{build.name} is not built. {build.problems[0].text(self._root)}" for build in builds if build.problems
        )

    def _read_stamps(self) -> _Stamps:
        found = []
        for folder in sorted((self._root / "src").glob("*")):
            if not any((folder / name).is_dir() for name in _FOLDERS):
                continue
            files = [folder / name for name in _NAMES]
            files += [path for name in _FOLDERS for path in sorted((folder / name).glob("*"))]
            for path in files:
                try:
                    status = path.stat()
                except OSError:
                    continue
                found.append((str(path), status.st_mtime_ns, status.st_size))
        return tuple(found)
