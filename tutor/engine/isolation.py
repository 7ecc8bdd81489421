"""Isolates a learner's processes for `ros-tutor check --isolate`, by bubblewrap's namespaces and the kernel's limits.

We stay outside, with the user's files and the report; only the network is shared, where the observers meet the nodes.
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
"""The memory that a process may write to (our solutions' nodes: 165 to 230 MB), the size of a file, and how many
processes and threads one start may have (ours: 13 to 60)."""
_MOST_FILES, _MOST_MB = 2000, 64
"""What there may be to copy of a submission."""
_INSTALL = "install it (sudo apt install bubblewrap), or check without --isolate only code that you would run yourself"
_ALLOW = (
    "if the kernel refuses, allow user namespaces (on Ubuntu 24.04: sudo sysctl "
    "kernel.apparmor_restrict_unprivileged_userns=0), or check on another machine"
)
_SYSTEM = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/opt/ros")
_OF_ETC = ("ld.so.cache", "alternatives", "passwd", "group", "hosts", "nsswitch.conf", "localtime", "timezone")
_SIOCSIFFLAGS, _IFF_UP = 0x8914, 0x1


@dataclass(frozen=True, slots=True)
class Isolation:
    """How processes are isolated on this machine: `Isolation.set_up` has tried it. `turn_socket`: see `turns`."""

    bwrap: str
    prlimit: str
    turn_socket: socket.socket
    limits_processes: bool = True

    @classmethod
    def set_up(cls) -> Isolation:
        """Move this process into a network of its own, and try to isolate another. It must have one thread only.

        Raises EngineError where it fails: nothing must then be checked as if it were isolated.
        """
        bwrap, prlimit = shutil.which("bwrap"), shutil.which("prlimit")
        if bwrap is None or prlimit is None:
            raise EngineError(f"--isolate needs {'prlimit' if bwrap else 'bubblewrap'}, which is not here", _INSTALL)
        isolation = cls(bwrap, prlimit, turns.turn_socket())  # of the network that all checks have in common
        try:
            _own_network()
        except OSError as error:
            raise EngineError(
                f"--isolate: this machine allows no network of its own ({error.strerror})", _ALLOW
            ) from error
        tried = subprocess.run([*isolation._command([], {}), "true"], capture_output=True, text=True, check=False)
        if tried.returncode:
            said = (tried.stderr.strip().splitlines() or [f"exit code {tried.returncode}"])[-1]
            raise EngineError(f"--isolate: bubblewrap cannot isolate anything here ({said})", _ALLOW)
        forked = subprocess.run(
            [*isolation._command([], {}, processes=1), "sh", "-c", "(true); true"], capture_output=True, check=False
        )
        return replace(isolation, limits_processes=forked.returncode != 0)

    def wrap(self, submission: Path, logs: Path, env: dict[str, str]) -> list[str]:
        """The command to put in front of another to isolate it; to be run with `env`, which is changed to fit.

        It may write to a copy of the submission, which it finds in its own place, and to `logs`. Raises
        EngineError where the submission cannot be copied.
        """
        env |= {"HOME": "/tmp", "TMPDIR": "/tmp"}
        copy = logs / "submission"
        _copy(submission, copy)
        return self._command(list(_readable(env)), {submission: copy, logs: logs})

    @property
    def restrictions(self) -> tuple[Restriction, ...]:
        """For the report: what is restricted, and why something is not."""
        count = f"{PROCESSES} of one start, threads included"
        root = "the kernel sets root no such limit: check as another user"
        return (
            Restriction("user", True, "a namespace of its own, without the user's rights"),
            Restriction("network", True, "the loopback interface of the check's own network, and no other"),
            Restriction("processes", True, "only its own can be seen or ended"),
            Restriction(
                "files", True, "the system and ROS to read, no home; a copy of the submission and /tmp to write"
            ),
            Restriction("memory limit", True, f"{MEMORY_MB} MB for each process"),
            Restriction("file limit", True, f"{FILE_MB} MB for each file"),
            Restriction("process limit", self.limits_processes, count if self.limits_processes else root),
        )

    def _command(self, readable: list[Path], writable: Mapping[Path, Path], processes: int = PROCESSES) -> list[str]:
        in_memory = ("--size", str(FILE_MB << 20), "--tmpfs")
        words = [self.bwrap, "--die-with-parent", "--unshare-user", "--unshare-pid", "--unshare-ipc", "--unshare-uts"]
        words += [
            "--unshare-cgroup-try",
            "--proc",
            "/proc",
            "--dev",
            "/dev",
            *in_memory,
            "/dev/shm",
            *in_memory,
            "/tmp",
        ]
        for folder in _SYSTEM:
            if os.path.islink(folder):  # such as /bin, to usr/bin
                words += ["--symlink", os.readlink(folder), folder]
            elif os.path.isdir(folder):
                words += ["--ro-bind", folder, folder]
        for name in _OF_ETC:
            words += ["--ro-bind-try", f"/etc/{name}", f"/etc/{name}"]
        for each in readable:
            words += ["--ro-bind", str(each), str(each)]
        for place, real in writable.items():
            words += ["--bind", str(real), str(place)]
        words += ["--remount-ro", "/dev", "--remount-ro", "/", "--chdir", "/", "--"]
        limits = (f"--data={MEMORY_MB << 20}", f"--fsize={FILE_MB << 20}", f"--nproc={processes}", "--core=0")
        return [*words, self.prlimit, *limits, "--"]


def _own_network() -> None:
    """Leave the machine's network for one that has only a loopback interface. Raises OSError."""
    uid, gid = os.geteuid(), os.getegid()
    try:
        os.unshare(os.CLONE_NEWNET)
    except PermissionError:
        if uid == 0:  # in a user namespace of its own, root would lose what belongs to other users
            raise
        os.unshare(os.CLONE_NEWUSER | os.CLONE_NEWNET)
        for name, text in (("setgroups", "deny"), ("uid_map", f"{uid} {uid} 1"), ("gid_map", f"{gid} {gid} 1")):
            Path("/proc/self", name).write_text(text)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, _SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", _IFF_UP))


def _readable(env: Mapping[str, str]) -> Iterator[Path]:
    """Python, our own code and ROS, where they are outside of the system's folders."""
    python = Path(sys.executable)
    hops = [python]
    while hops[-1].is_symlink():
        hops.append(Path(os.path.normpath(hops[-1].parent / os.readlink(hops[-1]))))
    named = [
        entry
        for name in ("PYTHONPATH", "AMENT_PREFIX_PATH", "LD_LIBRARY_PATH")
        for entry in env.get(name, "").split(":")
    ]
    homes = (Path(os.path.expanduser("~")), Path("/"), Path("/tmp"))
    wanted = [Path(sys.prefix), Path(sys.base_prefix), *(hop.parent.parent for hop in hops)]
    wanted += [Path(__file__).resolve().parents[1], *map(Path, filter(os.path.isabs, named))]
    for folder in dict.fromkeys(wanted):
        if (
            folder.is_dir()
            and not folder.is_relative_to("/usr")
            and not any(home.is_relative_to(folder) for home in homes)
        ):
            yield folder


def _copy(submission: Path, copy: Path) -> None:
    """Copy files and folders; links stay links, and whatever else there is stays away."""
    count = size = 0

    def left_out(folder: str, names: list[str]) -> list[str]:
        nonlocal count, size
        kinds = {name: os.lstat(os.path.join(folder, name)) for name in names}
        count, size = count + len(names), size + sum(each.st_size for each in kinds.values())
        if count > _MOST_FILES or size > _MOST_MB << 20:
            raise EngineError(
                f"--isolate: {submission} holds more than {_MOST_FILES} files or {_MOST_MB} MB, too much to be copied",
                "put the submission into a folder of its own",
            )
        usual = (stat.S_IFREG, stat.S_IFDIR, stat.S_IFLNK)
        return [name for name, each in kinds.items() if stat.S_IFMT(each.st_mode) not in usual]

    try:
        shutil.copytree(submission, copy, symlinks=True, ignore=left_out)
    except (OSError, shutil.Error) as error:
        raise EngineError(f"--isolate: {submission} cannot be copied: {error}", "make its files readable") from error
