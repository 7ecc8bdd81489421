"""Which workspace of this machine has which ROS domain: claims in a folder that all of the machine's users share.

A claim is a small file that its user alone can change. The folder is never trusted: what is odd about it (a link, a
folder that cannot be written to, a file that is not a claim) is passed over, and nothing outside of it is touched.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import socket
import stat
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tutor.workspace.locking import lock

REGISTRY = Path("/tmp/ros-tutor-domains")  # not $TMPDIR: it may be another one for each user
USABLE = range(1, 102)
"""The ids to choose from: those that Linux keeps free of other ports, but for 0, where everybody else is."""

_LOCK_LIMIT_S = 5.0
_KEPT_WITHOUT_WORKSPACE_S = 86400.0
_LARGEST = 4096
_MOST = 1000
_CAREFULLY = os.O_NOFOLLOW | os.O_CLOEXEC


@dataclass(frozen=True, slots=True)
class Claim:
    """A domain that a workspace has. `used_at` is in seconds since the epoch."""

    domain: int
    workspace: str
    uid: int
    used_at: float


def claimed_by(workspace: Path, registry: Path = REGISTRY) -> int | None:
    """The domain that this user's workspace has claimed, if it has; the claim is marked as used."""
    name = _name(workspace)
    try:
        with _folder(registry) as folder:
            claim = _read(folder, name)
            if claim is None or claim.workspace != str(workspace):
                return None
            os.utime(name, dir_fd=folder, follow_symlinks=False)
            return claim.domain
    except OSError:
        return None


def claim(
    workspace: Path,
    wanted: Callable[[], int | None],
    in_use: Callable[[], Collection[int]],
    registry: Path = REGISTRY,
) -> int | None:
    """Have a domain for `workspace`: the one that it has, else the wanted one, else one that no other has.

    `wanted` and `in_use` (ids on which something else is, to be avoided) are asked while no other process can claim.
    Gives None where the registry cannot be used. Safe among threads, processes and users.
    """
    try:
        with _folder(registry, make=True) as folder, _locked(folder):
            own, others = None, []
            for each in _claims(folder):
                if each.workspace != str(workspace):
                    others.append(each)
                elif each.uid == os.getuid():
                    own = each.domain
            taken = {each.domain for each in others}
            chosen = wanted()
            if chosen is None:
                chosen = own
            if chosen is None or (chosen in taken and chosen != own):
                chosen = _choose(workspace, others, in_use())
            _write(folder, workspace, chosen)
            return chosen
    except (OSError, TimeoutError):
        return None


def preferred(workspace: Path) -> list[int]:
    """All usable ids, in an order that differs from workspace to workspace, user to user and machine to machine."""
    identity = f"{socket.gethostname()}:{os.getuid()}:{workspace}"
    start = int.from_bytes(hashlib.sha256(identity.encode()).digest()[:8]) % len(USABLE)
    return [*USABLE[start:], *USABLE[:start]]


def _choose(workspace: Path, others: list[Claim], in_use: Collection[int]) -> int:
    taken = {claim.domain for claim in others}
    free = [domain for domain in preferred(workspace) if domain not in taken]
    quiet = [domain for domain in free if domain not in in_use]
    if quiet or free:
        return (quiet or free)[0]
    last_used = {domain: max(claim.used_at for claim in others if claim.domain == domain) for domain in USABLE}
    return min(USABLE, key=last_used.__getitem__)  # there are more workspaces than domains


# --- the folder and its files ---


@contextmanager
def _folder(path: Path, *, make: bool = False) -> Iterator[int]:
    if make:
        with contextlib.suppress(FileExistsError):
            path.mkdir(mode=0o1777)
    handle = os.open(path, os.O_RDONLY | os.O_DIRECTORY | _CAREFULLY)
    try:
        found = os.fstat(handle)
        if make and found.st_uid == os.getuid() and stat.S_IMODE(found.st_mode) != 0o1777:
            os.fchmod(handle, 0o1777)  # past the umask: every user may add claims, and change only their own
        yield handle
    finally:
        os.close(handle)


@contextmanager
def _locked(folder: int) -> Iterator[None]:
    handle = _lock_file(folder)
    try:
        if not stat.S_ISREG(os.fstat(handle).st_mode) or not lock(handle, _LOCK_LIMIT_S):
            raise TimeoutError
        yield
    finally:
        os.close(handle)


def _lock_file(folder: int) -> int:
    careful = os.O_RDONLY | os.O_NONBLOCK | _CAREFULLY
    try:
        return os.open("lock", careful, dir_fd=folder)
    except FileNotFoundError:
        pass
    # Opening it with O_CREAT where it is another user's would be refused (fs.protected_regular).
    with contextlib.suppress(FileExistsError):
        handle = os.open("lock", careful | os.O_CREAT | os.O_EXCL, 0o644, dir_fd=folder)
        os.fchmod(handle, 0o644)
        return handle
    return os.open("lock", careful, dir_fd=folder)


def _name(workspace: Path) -> str:
    return f"{os.getuid()}-{hashlib.sha256(os.fsencode(workspace)).hexdigest()[:16]}"


def _claims(folder: int) -> list[Claim]:
    """The claims that hold. Those of this user whose workspace is gone are taken away."""
    found = []
    for name in sorted(os.listdir(folder))[:_MOST]:
        claim = _read(folder, name)
        if claim is None:
            continue
        if claim.uid == os.getuid() and _is_over(claim):
            with contextlib.suppress(OSError):
                os.unlink(name, dir_fd=folder)
        else:
            found.append(claim)
    return found


def _is_over(claim: Claim) -> bool:
    return not os.path.lexists(claim.workspace) and time.time() - claim.used_at > _KEPT_WITHOUT_WORKSPACE_S


def _read(folder: int, name: str) -> Claim | None:
    owner, separator, _ = name.partition("-")
    if not separator or not owner.isdecimal():
        return None
    try:
        handle = os.open(name, os.O_RDONLY | os.O_NONBLOCK | _CAREFULLY, dir_fd=folder)
    except OSError:
        return None
    with os.fdopen(handle, "rb") as file:
        about = os.fstat(handle)
        if not stat.S_ISREG(about.st_mode) or about.st_uid != int(owner):
            return None
        try:
            claim = json.loads(file.read(_LARGEST))
            domain, workspace = claim["domain"], claim["workspace"]
        except (OSError, ValueError, TypeError, KeyError, RecursionError):
            return None
    if type(domain) is not int or type(workspace) is not str:
        return None
    return Claim(domain, workspace, about.st_uid, about.st_mtime)


def _write(folder: int, workspace: Path, domain: int) -> None:
    name = _name(workspace)
    temporary = f".{name}"
    with contextlib.suppress(FileNotFoundError):
        os.unlink(temporary, dir_fd=folder)
    handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _CAREFULLY, 0o644, dir_fd=folder)
    with os.fdopen(handle, "wb") as file:
        os.fchmod(handle, 0o644)
        file.write(json.dumps({"domain": domain, "workspace": str(workspace)}).encode("utf-8"))
    os.rename(temporary, name, src_dir_fd=folder, dst_dir_fd=folder)
