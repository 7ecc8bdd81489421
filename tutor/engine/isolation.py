"""Isolates a submission for `ros-tutor check --isolate` with bubblewrap's namespaces and the kernel's limits.

Our own process stays outside, with the user's files and the report. It shares only a network namespace with the
isolated processes, so that our observers can discover the nodes. The runs of a submission share a sandbox, as they
share a folder and the machine without isolation.
"""

from __future__ import annotations

import os
import shutil
import socket
import stat
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Self

from tutor import private_folders
from tutor.engine.environment import node_env, package_folder, start_fork_server
from tutor.engine.interfaces import build_beside
from tutor.engine.scheduling import kept_turn_socket
from tutor.errors import EngineError
from tutor.judge.result import Restriction
from tutor.judge.submission import Submission
from tutor.process import namespaces
from tutor.process.isolation_support import NamespaceSupport, why_not
from tutor.process.log_folder import temporary_log_folder
from tutor.process.run_limits import MAX_MB, MAX_TASKS
from tutor.process.spawner import Spawner
from tutor.ros.environment import RosEnvironment

MEMORY_MB, FILE_MB, TASKS = 2048, 64, 2 * MAX_TASKS
"""The kernel's limits on the writable memory of a process (our solutions' nodes use 165 to 230 MB), the size of a file,
and the processes and threads of a submission: of all its runs together, which are fewer than a dozen at a time."""
DISK_MB, FILES = 256, 10_000
"""Limits on all that a submission writes, which is in memory."""

TEMPORARY = Path("/tmp/isolated")
"""Where a submission's programs make temporary files. Not in /tmp itself, where its own folder may be: programs of ours
would take that for the leftovers of a killed process, since its lock is outside."""

_SYSTEM_FOLDERS = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/opt/ros")
_ETC_FILES = ("ld.so.cache", "alternatives", "passwd", "group", "hosts", "nsswitch.conf", "localtime", "timezone")
_NAMESPACES = ("--unshare-user", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try")
_NO_MORE_NAMESPACES = "--disable-userns"  # since bubblewrap 0.8
_KILL_FIRST = ("-n", "1000", "--")
"""Arguments of choom: when the machine runs out of memory, the kernel ends these processes before all others."""

_MAX_FILES, _MAX_MB = 2000, 64
"""Limits on the copy of a submission."""

_VARIABLES = frozenset(["COLORTERM", "LANG", "LANGUAGE", "LD_LIBRARY_PATH", "NO_COLOR", "PATH", "TERM", "TZ"])
_VARIABLE_PREFIXES = (
    *("AMENT_", "COLCON_", "CYCLONEDDS_", "FASTDDS_", "FASTRTPS_", "LC_", "OMP_", "OPENBLAS_", "PYTHON", "RCL_"),
    *("RCUTILS_", "RMW_", "ROS_", "_ROS_WHEELS_"),
)
"""The environment variables that a submission gets. Others may be a teacher's secrets."""


@dataclass(frozen=True, slots=True)
class Isolation:
    """A working way to isolate processes on this machine; made by `Isolation.set_up`.

    `turn_socket`: see `scheduling.turn`. `prefix` comes before a command in isolation; `no_namespaces`: a submission
    can make no namespaces of its own.
    """

    bwrap: str
    prefix: tuple[str, ...]
    turn_socket: socket.socket
    no_namespaces: bool = True

    @classmethod
    def set_up(cls) -> Isolation:
        """Move this process into namespaces of its own, and try to isolate a child process.

        This process must be single-threaded. Raises EngineError if isolation fails; then nothing may be checked.
        """
        bwrap, prlimit, choom = (shutil.which(name) for name in ("bwrap", "prlimit", "choom"))
        support = NamespaceSupport.read()
        if bwrap is None:
            raise why_not("", support, bwrap)
        if prlimit is None:
            raise EngineError(
                "isolation needs prlimit, which is not installed", "install it: sudo apt install util-linux"
            )
        limits = (f"--data={MEMORY_MB << 20}", f"--fsize={FILE_MB << 20}", f"--nproc={TASKS}", "--core=0", "--")
        prefix = (*((choom, *_KILL_FIRST) if choom else ()), prlimit, *limits)
        isolation = cls(bwrap, prefix, kept_turn_socket())  # made in the network namespace that all checks share
        try:
            namespaces.enter(bwrap)
        except OSError as error:
            raise why_not(error.strerror or str(error), support, bwrap) from error
        if isolation._fault() is None:
            return isolation
        isolation = replace(isolation, no_namespaces=False)
        if fault := isolation._fault():
            raise why_not(fault, support, bwrap)
        return isolation

    @property
    def restrictions(self) -> tuple[Restriction, ...]:
        """What is restricted, for the report, and why something is not."""
        alone = "makes no namespaces of its own"
        old = "this bubblewrap cannot keep a submission from making namespaces of its own: 0.8 or later can"
        return (
            Restriction("user", True, "a private namespace, without the user's privileges and environment variables"),
            Restriction("namespaces", self.no_namespaces, alone if self.no_namespaces else old),
            Restriction("network", True, "only the loopback interface of the check's private network"),
            Restriction("processes", True, "only its own can be seen or killed"),
            Restriction(
                "files", True, "the system and ROS read-only, no home; a copy of the submission and /tmp writable"
            ),
            Restriction("disk limit", True, f"{DISK_MB} MB and {FILES} files, in memory; {FILE_MB} MB per file"),
            Restriction("memory limit", True, f"{MEMORY_MB} MB per process, {MAX_MB} MB per run"),
            Restriction("process limit", True, f"{MAX_TASKS} per run, threads included"),
        )

    def command(self, readable: Sequence[Path], writable: Mapping[Path, Path]) -> list[str]:
        """Return the command prefix that isolates a command.

        `readable`: folders besides the system's. `writable`: mount points, and the folders outside that are there.
        """
        command = [self.bwrap, "--die-with-parent", *_NAMESPACES, "--proc", "/proc", "--dev", "/dev"]
        if self.no_namespaces:
            command.append(_NO_MORE_NAMESPACES)
        for folder in _SYSTEM_FOLDERS:
            if os.path.islink(folder):  # such as /bin to usr/bin
                command += ["--symlink", os.readlink(folder), folder]
            elif os.path.isdir(folder):
                command += ["--ro-bind", folder, folder]
        for name in _ETC_FILES:
            command += ["--ro-bind-try", f"/etc/{name}", f"/etc/{name}"]
        mounts = [("--ro-bind", folder, folder) for folder in readable]
        mounts += [("--bind", outside, inside) for inside, outside in writable.items()]
        for option, outside, inside in sorted(mounts, key=lambda mount: len(mount[2].parts)):
            command += [option, str(outside), str(inside)]
        return [*command, "--remount-ro", "/dev", "--remount-ro", "/", "--chdir", "/", "--", *self.prefix]

    def _fault(self) -> str | None:
        """Try to isolate a command; return what was said if that fails."""
        argv = [*self.command([], {}), "true"]
        trial = subprocess.run(argv, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"}, check=False)
        if trial.returncode == 0:
            return None
        return (trial.stderr.strip().splitlines() or [f"exit code {trial.returncode}"])[-1]


def restrict_environment(env: dict[str, str]) -> None:
    """Leave only what a node needs in its environment, and no path of the user's home."""
    for name in set(env) - _VARIABLES:
        if not name.startswith(_VARIABLE_PREFIXES):
            del env[name]
    env |= {"HOME": "/tmp", "TMPDIR": str(TEMPORARY)}


def readable_folders(env: Mapping[str, str]) -> Iterator[Path]:
    """Yield the folders of Python, our own code and ROS, as far as they are outside the system folders."""
    python = Path(sys.executable)
    hops = [python]
    while hops[-1].is_symlink():
        hops.append(Path(os.path.normpath(hops[-1].parent / os.readlink(hops[-1]))))
    from_env = [
        entry
        for name in ("PYTHONPATH", "AMENT_PREFIX_PATH", "LD_LIBRARY_PATH")
        for entry in env.get(name, "").split(":")
    ]
    homes = (Path(os.path.expanduser("~")), Path("/"), Path("/tmp"))
    wanted = [Path(sys.prefix), Path(sys.base_prefix), *(hop.parent.parent for hop in hops)]
    wanted += [Path(__file__).resolve().parents[1], *map(Path, filter(os.path.isabs, from_env))]
    for folder in dict.fromkeys(wanted):
        if (
            folder.is_dir()
            and not folder.is_relative_to("/usr")
            and not any(home.is_relative_to(folder) for home in homes)
        ):
            yield folder


class Sandbox:
    """Where one submission runs in isolation: its copy, all that it writes, and the fork server of its nodes."""

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
        for new_folder in (self._logs, self._given, tmp, tmp / TEMPORARY.relative_to("/tmp"), shm):
            new_folder.mkdir()
        _copy_submission(folder, copy)
        env = node_env(ros, 0, Path(os.devnull), None)
        built = [build.prefix for build in build_beside(folder / "package.xml", ros) if build.prefix]
        readable = [*readable_folders(env), tools, self._given, *built]
        writable = {folder: copy, self._logs: self._logs, Path("/tmp"): tmp, Path("/dev/shm"): shm}
        command = isolation.command(readable, writable)
        restrict_environment(env)
        self.spawner = Spawner(stack.enter_context(start_fork_server(ros, modules, env, command)), command)

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

    def __init__(self, isolation: Isolation, submissions: Iterable[Submission]) -> None:
        self.isolation = isolation
        files = (path.resolve() for submission in submissions for path in submission.files.values())
        self._folders = frozenset(map(package_folder, files))
        self._made: dict[Path, Sandbox | EngineError] = {}
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.close()

    def start(self, ros: RosEnvironment, tools: Path, modules: Iterable[str]) -> None:
        """Make them all, without waiting for what their fork servers import. `tools`: see `Machine`."""
        for folder in self._folders:
            try:
                self._made[folder] = self._make(folder, ros, tools, modules)
            except EngineError as error:
                self._made[folder] = error

    def of(self, path: Path) -> Sandbox:
        """Return that of the submission that a file belongs to. Raises EngineError if it could not be made."""
        changed = EngineError("the submission's folder was changed during its check")
        made = self._made.get(package_folder(path), changed)
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
            sandbox = Sandbox(self.isolation, folder, disk, ros, tools, modules, stack)
            self._stack.push(stack.pop_all())
            return sandbox


def _copy_submission(submission: Path, copy: Path) -> None:
    """Copy files, folders and symbolic links as such; leave out anything else, such as sockets and FIFOs."""
    count = size = 0

    def find_special(folder: str, names: list[str]) -> list[str]:
        nonlocal count, size
        stats = {name: os.lstat(os.path.join(folder, name)) for name in names}
        count, size = count + len(names), size + sum(status.st_size for status in stats.values())
        if count > _MAX_FILES or size > _MAX_MB << 20:
            raise EngineError(
                f"{submission} is too large to copy: more than {_MAX_FILES} files or {_MAX_MB} MB",
                "put the submission into a folder of its own",
            )
        copied = (stat.S_IFREG, stat.S_IFDIR, stat.S_IFLNK)
        return [name for name, status in stats.items() if stat.S_IFMT(status.st_mode) not in copied]

    try:
        shutil.copytree(submission, copy, symlinks=True, ignore=find_special)
    except (OSError, shutil.Error) as error:
        raise EngineError(f"{submission} cannot be copied: {error}", "make its files readable") from error
