"""Linux namespaces of this process, and file systems in memory that only it and its children see.

A user namespace comes from bubblewrap, which this process then enters. Where AppArmor lets only programs with a profile
of their own make one, as on Ubuntu 24.04, a profile for bubblewrap is enough.
"""

from __future__ import annotations

import contextlib
import ctypes
import fcntl
import os
import socket
import struct
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_SIOCSIFFLAGS, _IFF_UP = 0x8914, 0x1
_MS_NOSUID, _MS_NODEV, _MS_REC, _MS_SLAVE = 0x2, 0x4, 0x4000, 0x80000
_MNT_DETACH = 0x2

_HOLDER = ("--unshare-user", "--unshare-net", "--die-with-parent", "--dev-bind", "/", "/", "--")
_TELL_PID_AND_WAIT = ("sh", "-c", "echo $$; read _")


def enter(bwrap: str) -> None:
    """Enter a network namespace that has only a loopback interface, and a mount namespace of our own.

    This process must be single-threaded. Raises OSError, with what bubblewrap said if that failed.
    """
    if os.geteuid() == 0:  # in a user namespace, root would lose access to other users' files
        os.unshare(os.CLONE_NEWNET)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
            fcntl.ioctl(any_socket, _SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", _IFF_UP))
    else:
        _enter_those_of(bwrap)
    os.unshare(os.CLONE_NEWNS)
    _mount(None, "/", None, _MS_REC | _MS_SLAVE)  # what we mount stays here


@contextmanager
def tmpfs(folder: Path, size: int, files: int) -> Iterator[None]:
    """Mount a file system in memory on a folder, for us and our children: at most `size` bytes and `files` files.

    Only after `enter`. Raises OSError.
    """
    _mount("tmpfs", str(folder), "tmpfs", _MS_NOSUID | _MS_NODEV, f"size={size},nr_inodes={files},mode=700")
    try:
        yield
    finally:
        _libc().umount2(os.fsencode(folder), _MNT_DETACH)


def _enter_those_of(bwrap: str) -> None:
    """Have bubblewrap make a user and a network namespace, and enter both, in which we then have all privileges."""
    with subprocess.Popen(
        [bwrap, *_HOLDER, *_TELL_PID_AND_WAIT],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, "LC_ALL": "C"},
        text=True,
    ) as holder:
        assert holder.stdout is not None
        pid = holder.stdout.readline()
        if not pid:
            assert holder.stderr is not None
            said = holder.stderr.read().strip().splitlines()
            raise OSError(said[-1] if said else f"bwrap: exit code {holder.wait()}")
        pidfd = os.pidfd_open(int(pid))
        try:
            os.setns(pidfd, os.CLONE_NEWUSER | os.CLONE_NEWNET)
        finally:
            os.close(pidfd)
            with contextlib.suppress(BrokenPipeError):
                holder.communicate("\n")


def _mount(source: str | None, target: str, kind: str | None, flags: int, data: str = "") -> None:
    words = (None if word is None else os.fsencode(word) for word in (source, target, kind))
    if _libc().mount(*words, ctypes.c_ulong(flags), os.fsencode(data)) != 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number), target)


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)
