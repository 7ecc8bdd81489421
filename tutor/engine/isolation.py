"""Isolates a learner's processes for `ros-tutor check --isolate` with bubblewrap's namespaces and the kernel's limits.

Our own process stays outside, with the user's files and the report. It shares only a network namespace with the
isolated processes, so that our observers can discover the nodes.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import socket
import stat
import struct
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from tutor.engine import turns
from tutor.errors import EngineError
from tutor.judge.result import Restriction

MEMORY_MB, FILE_MB, PROCESSES = 2048, 64, 512
"""Limits on the writable memory of a process (our solutions' nodes use 165 to 230 MB), the size of a file, and the
number of processes and threads in one run (ours have 13 to 60)."""
_MAX_FILES, _MAX_MB = 2000, 64
"""Limits on the copy of a submission."""
_INSTALL_HINT = (
    "install it (sudo apt install bubblewrap), or check without --isolate only code that you would run yourself"
)
_ALLOW_HINT = (
    "if the kernel refuses, allow user namespaces (on Ubuntu 24.04: sudo sysctl "
    "kernel.apparmor_restrict_unprivileged_userns=0), or check on another machine"
)
_SYSTEM_FOLDERS = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/opt/ros")
_ETC_FILES = ("ld.so.cache", "alternatives", "passwd", "group", "hosts", "nsswitch.conf", "localtime", "timezone")
_SIOCSIFFLAGS, _IFF_UP = 0x8914, 0x1


@dataclass(frozen=True, slots=True)
class Isolation:
    """A working way to isolate processes on this machine; made by `Isolation.set_up`. `turn_socket`: see `turns`."""

    bwrap: str
    prlimit: str
    turn_socket: socket.socket
    limits_processes: bool = True

    @classmethod
    def set_up(cls) -> Isolation:
        """Move this process into a private network namespace, and try to isolate a child process.

        This process must be single-threaded. Raises EngineError if isolation fails; then nothing may be checked.
        """
        bwrap, prlimit = shutil.which("bwrap"), shutil.which("prlimit")
        if bwrap is None or prlimit is None:
            raise EngineError(
                f"--isolate needs {'prlimit' if bwrap else 'bubblewrap'}, which is not installed", _INSTALL_HINT
            )
        isolation = cls(bwrap, prlimit, turns.turn_socket())  # made in the network namespace that all checks share
        try:
            _enter_private_network()
        except OSError as error:
            raise EngineError(
                f"--isolate: this machine allows no private network namespace ({error.strerror})", _ALLOW_HINT
            ) from error
        trial = subprocess.run([*isolation._bwrap_command([], {}), "true"], capture_output=True, text=True, check=False)
        if trial.returncode:
            reason = (trial.stderr.strip().splitlines() or [f"exit code {trial.returncode}"])[-1]
            raise EngineError(f"--isolate: bubblewrap cannot isolate anything here ({reason})", _ALLOW_HINT)
        forked = subprocess.run(
            [*isolation._bwrap_command([], {}, processes=1), "sh", "-c", "(true); true"],
            capture_output=True,
            check=False,
        )
        return replace(isolation, limits_processes=forked.returncode != 0)

    def wrap(self, submission: Path, logs: Path, env: dict[str, str], tools: Path | None = None) -> list[str]:
        """Return the command prefix that isolates a command; adapts `env`, with which that must be run.

        The command may read `tools`, write to `logs`, and to a copy of the submission that is mounted in its place.
        Raises EngineError if the submission cannot be copied.
        """
        env |= {"HOME": "/tmp", "TMPDIR": "/tmp"}
        copy = logs / "submission"
        _copy_submission(submission, copy)
        readable = [*_readable_folders(env), *([tools] if tools is not None else [])]
        return self._bwrap_command(readable, {submission: copy, logs: logs})

    @property
    def restrictions(self) -> tuple[Restriction, ...]:
        """What is restricted, for the report, and why something is not."""
        count = f"{PROCESSES} per run, threads included"
        root = "the kernel sets no such limit for root: check as another user"
        return (
            Restriction("user", True, "a private namespace, without the user's privileges"),
            Restriction("network", True, "only the loopback interface of the check's private network"),
            Restriction("processes", True, "only its own can be seen or killed"),
            Restriction(
                "files", True, "the system and ROS read-only, no home; a copy of the submission and /tmp writable"
            ),
            Restriction("memory limit", True, f"{MEMORY_MB} MB per process"),
            Restriction("file limit", True, f"{FILE_MB} MB per file"),
            Restriction("process limit", self.limits_processes, count if self.limits_processes else root),
        )

    def _bwrap_command(
        self, readable: list[Path], writable: Mapping[Path, Path], processes: int = PROCESSES
    ) -> list[str]:
        tmpfs = ("--size", str(FILE_MB << 20), "--tmpfs")
        command = [self.bwrap, "--die-with-parent", "--unshare-user", "--unshare-pid", "--unshare-ipc", "--unshare-uts"]
        command += [
            "--unshare-cgroup-try",
            "--proc",
            "/proc",
            "--dev",
            "/dev",
            *tmpfs,
            "/dev/shm",
            *tmpfs,
            "/tmp",
        ]
        for folder in _SYSTEM_FOLDERS:
            if os.path.islink(folder):  # such as /bin to usr/bin
                command += ["--symlink", os.readlink(folder), folder]
            elif os.path.isdir(folder):
                command += ["--ro-bind", folder, folder]
        for name in _ETC_FILES:
            command += ["--ro-bind-try", f"/etc/{name}", f"/etc/{name}"]
        for each in readable:
            command += ["--ro-bind", str(each), str(each)]
        for mount_point, folder_outside in writable.items():
            command += ["--bind", str(folder_outside), str(mount_point)]
        command += ["--remount-ro", "/dev", "--remount-ro", "/", "--chdir", "/", "--"]
        limits = (f"--data={MEMORY_MB << 20}", f"--fsize={FILE_MB << 20}", f"--nproc={processes}", "--core=0")
        return [*command, self.prlimit, *limits, "--"]


def _enter_private_network() -> None:
    """Move this process into a network namespace that has only a loopback interface. Raises OSError."""
    uid, gid = os.geteuid(), os.getegid()
    try:
        os.unshare(os.CLONE_NEWNET)
    except PermissionError:
        if uid == 0:  # in a private user namespace, root would lose access to other users' files
            raise
        os.unshare(os.CLONE_NEWUSER | os.CLONE_NEWNET)
        for name, text in (("setgroups", "deny"), ("uid_map", f"{uid} {uid} 1"), ("gid_map", f"{gid} {gid} 1")):
            Path("/proc/self", name).write_text(text)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, _SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", _IFF_UP))


def _readable_folders(env: Mapping[str, str]) -> Iterator[Path]:
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


def _copy_submission(submission: Path, copy: Path) -> None:
    """Copy files, folders and symbolic links as such; leave out anything else, such as sockets and FIFOs."""
    count = size = 0

    def find_special(folder: str, names: list[str]) -> list[str]:
        nonlocal count, size
        stats = {name: os.lstat(os.path.join(folder, name)) for name in names}
        count, size = count + len(names), size + sum(each.st_size for each in stats.values())
        if count > _MAX_FILES or size > _MAX_MB << 20:
            raise EngineError(
                f"--isolate: {submission} is too large to copy: more than {_MAX_FILES} files or {_MAX_MB} MB",
                "put the submission into a folder of its own",
            )
        copied = (stat.S_IFREG, stat.S_IFDIR, stat.S_IFLNK)
        return [name for name, each in stats.items() if stat.S_IFMT(each.st_mode) not in copied]

    try:
        shutil.copytree(submission, copy, symlinks=True, ignore=find_special)
    except (OSError, shutil.Error) as error:
        raise EngineError(f"--isolate: {submission} cannot be copied: {error}", "make its files readable") from error
