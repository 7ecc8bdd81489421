"""Isolates a submission for `ros-tutor check --isolate` with bubblewrap's namespaces and the kernel's limits.

Our own process stays outside, with the user's files and the report. It shares only a network namespace with the
isolated processes, so that our observers can discover the nodes.
"""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from tutor.engine import turns
from tutor.errors import EngineError
from tutor.judge.result import Restriction
from tutor.process import namespaces
from tutor.process.isolation_support import Machine, why_not
from tutor.process.run_limits import MAX_MB, MAX_TASKS

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

_VARIABLES = frozenset(["COLORTERM", "LANG", "LANGUAGE", "LD_LIBRARY_PATH", "NO_COLOR", "PATH", "TERM", "TZ"])
_VARIABLE_PREFIXES = (
    *("AMENT_", "COLCON_", "CYCLONEDDS_", "FASTDDS_", "FASTRTPS_", "LC_", "OMP_", "OPENBLAS_", "PYTHON", "RCL_"),
    *("RCUTILS_", "RMW_", "ROS_", "_ROS_WHEELS_"),
)
"""The environment variables that a submission gets. Others may be a teacher's secrets."""


@dataclass(frozen=True, slots=True)
class Isolation:
    """A working way to isolate processes on this machine; made by `Isolation.set_up`. `turn_socket`: see `turns`.

    `prefix` comes before a command in isolation; `no_namespaces`: a submission can make no namespaces of its own.
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
        machine = Machine.read()
        if bwrap is None:
            raise why_not("", machine, bwrap)
        if prlimit is None:
            raise EngineError(
                "isolation needs prlimit, which is not installed", "install it: sudo apt install util-linux"
            )
        limits = (f"--data={MEMORY_MB << 20}", f"--fsize={FILE_MB << 20}", f"--nproc={TASKS}", "--core=0", "--")
        prefix = (*((choom, *_KILL_FIRST) if choom else ()), prlimit, *limits)
        isolation = cls(bwrap, prefix, turns.kept_turn_socket())  # made in the network namespace that all checks share
        try:
            namespaces.enter(bwrap)
        except OSError as error:
            raise why_not(error.strerror or str(error), machine, bwrap) from error
        if isolation._fault() is None:
            return isolation
        isolation = replace(isolation, no_namespaces=False)
        if fault := isolation._fault():
            raise why_not(fault, machine, bwrap)
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
