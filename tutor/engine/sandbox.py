"""Where a submission runs in isolation: its copy, all that it writes, and the fork server of its nodes.

The runs of a submission share these, as they share a folder and the machine without isolation. Those of another
submission have theirs.
"""

from __future__ import annotations

import os
import shutil
import stat
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from types import TracebackType
from typing import Self

from tutor import private_folders
from tutor.engine.forking import node_env, start_fork_server
from tutor.engine.isolation import DISK_MB, FILES, TEMPORARY, Isolation, readable_folders, restrict_environment
from tutor.errors import EngineError
from tutor.process import namespaces
from tutor.process.fork_link import ForkServerLink
from tutor.process.log_folder import temporary_log_folder
from tutor.ros.environment import RosEnvironment

_MAX_FILES, _MAX_MB = 2000, 64
"""Limits on the copy of a submission."""


class Sandbox:
    """One submission's. `command`: the prefix that runs a command in it; `fork_server`: where programs are forked."""

    def __init__(
        self,
        isolation: Isolation,
        folder: Path,
        disk: Path,
        ros: RosEnvironment,
        tools: Path,
        modules: Iterable[str],
        stack: ExitStack,
    ) -> None:
        """`folder`: what is copied, and mounted in its place. `disk`: an empty folder for all that is written.

        Raises EngineError.
        """
        self._logs = disk / "logs"
        self._given = disk / "given"
        copy, tmp, shm = disk / "submission", disk / "tmp", disk / "shm"
        for each in (self._logs, self._given, tmp, tmp / TEMPORARY.relative_to("/tmp"), shm):
            each.mkdir()
        _copy_submission(folder, copy)
        env = node_env(ros, 0, Path(os.devnull), None)
        readable = [*readable_folders(env), tools, self._given]
        writable = {folder: copy, self._logs: self._logs, Path("/tmp"): tmp, Path("/dev/shm"): shm}
        self.command = isolation.command(readable, writable)
        restrict_environment(env)
        starting = start_fork_server(ros, modules, env, self.command)
        self.fork_server: ForkServerLink | None = stack.enter_context(starting)

    @contextmanager
    def folders(self) -> Iterator[tuple[Path, Path]]:
        """Create the log folder of a run, and a folder of ours for it, which it cannot change. Raises EngineError."""
        with ExitStack() as stack:
            try:
                log_dir = stack.enter_context(temporary_log_folder(self._logs))
                ours = self._given / log_dir.name
                ours.mkdir()
            except OSError as error:
                raise EngineError(
                    f"the submission has filled what it may write, {DISK_MB} MB and {FILES} files, so it cannot be "
                    f"started again: {error.strerror}",
                    "look for a loop that writes files",
                ) from error
            yield log_dir, ours


class Sandboxes:
    """The sandboxes of a check. A context manager that ends and removes them."""

    def __init__(self, isolation: Isolation, folders: Iterable[Path]) -> None:
        """`folders`: those of the submissions."""
        self._isolation = isolation
        self._folders = frozenset(folders)
        self._made: dict[Path, Sandbox | EngineError] = {}
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.close()

    def start(self, ros: RosEnvironment, tools: Path, modules: Iterable[str]) -> None:
        """Make them all, without waiting for what their fork servers import. `tools`: see `Prepared`."""
        for folder in self._folders:
            try:
                self._made[folder] = self._make(folder, ros, tools, modules)
            except EngineError as error:
                self._made[folder] = error

    def of(self, folder: Path) -> Sandbox:
        """Return that of the submission in a folder. Raises EngineError if it could not be made."""
        made = self._made.get(folder) or EngineError("the submission's folder was changed during its check")
        if isinstance(made, EngineError):
            raise made
        return made

    def _make(self, folder: Path, ros: RosEnvironment, tools: Path, modules: Iterable[str]) -> Sandbox:
        with ExitStack() as stack:
            try:
                disk = stack.enter_context(private_folders.temporary("sandbox")) / "disk"
                disk.mkdir()
                stack.enter_context(namespaces.tmpfs(disk, DISK_MB << 20, FILES))
            except OSError as error:
                raise EngineError(f"no file system in memory can be made for the submission: {error}") from error
            sandbox = Sandbox(self._isolation, folder, disk, ros, tools, modules, stack)
            self._stack.push(stack.pop_all())
            return sandbox


def _copy_submission(submission: Path, copy: Path) -> None:
    """Copy files, folders and symbolic links as such; leave out anything else, such as sockets and FIFOs."""
    count = size = 0

    def find_special(folder: str, names: list[str]) -> list[str]:
        nonlocal count, size
        stats = {name: os.lstat(os.path.join(folder, name)) for name in names}
        count, size = count + len(names), size + sum(each.st_size for each in stats.values())
        if count > _MAX_FILES or size > _MAX_MB << 20:
            raise EngineError(
                f"{submission} is too large to copy: more than {_MAX_FILES} files or {_MAX_MB} MB",
                "put the submission into a folder of its own",
            )
        copied = (stat.S_IFREG, stat.S_IFDIR, stat.S_IFLNK)
        return [name for name, each in stats.items() if stat.S_IFMT(each.st_mode) not in copied]

    try:
        shutil.copytree(submission, copy, symlinks=True, ignore=find_special)
    except (OSError, shutil.Error) as error:
        raise EngineError(f"{submission} cannot be copied: {error}", "make its files readable") from error
