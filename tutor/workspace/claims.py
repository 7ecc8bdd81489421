"""A machine-wide registry of which workspace uses which ROS domain, in a folder shared by all users.

A claim is a small file that only its owner can change. The folder is never trusted: anything odd (a link, a folder
that is not writable, a file that is not a claim) is ignored, and nothing outside the folder is touched.
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

REGISTRY = Path("/tmp/ros-tutor-domains")  # not $TMPDIR, which may differ between users
USABLE_DOMAINS = range(1, 102)
"""The domain ids to choose from: their ports are outside Linux's ephemeral range; 0 is the default of everyone else."""

_LOCK_TIMEOUT_S = 5.0
_CLAIM_LIFETIME_S = 86400.0
"""How long a claim is kept after its last use if its workspace no longer exists."""
_MAX_CLAIM_BYTES = 4096
_MAX_CLAIMS = 1000
_SAFE_OPEN_FLAGS = os.O_NOFOLLOW | os.O_CLOEXEC


@dataclass(frozen=True, slots=True)
class Claim:
    """A workspace's claim of a domain. `used_at` is in seconds since the epoch."""

    domain: int
    workspace: str
    uid: int
    used_at: float


def claimed_by(workspace: Path, registry: Path = REGISTRY) -> int | None:
    """Return the domain claimed by this user's workspace, if any, and mark the claim as used."""
    name = _claim_file_name(workspace)
    try:
        with _open_folder(registry) as folder:
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
    """Claim a domain for `workspace`: the wanted one, else the one already claimed, else one that no other claims.

    `wanted` and `in_use` (ids with other participants, to be avoided) are called while no other process can claim.
    Returns None if the registry cannot be used. Safe across threads, processes and users.
    """
    try:
        with _open_folder(registry, create=True) as folder, _locked(folder):
            own, others = None, []
            for existing in _read_claims(folder):
                if existing.workspace != str(workspace):
                    others.append(existing)
                elif existing.uid == os.getuid():
                    own = existing.domain
            taken = {existing.domain for existing in others}
            chosen = wanted()
            if chosen is None:
                chosen = own
            if chosen is None or (chosen in taken and chosen != own):
                chosen = _choose(workspace, others, in_use())
            _write(folder, workspace, chosen)
            return chosen
    except (OSError, TimeoutError):
        return None


def preferred_order(workspace: Path) -> list[int]:
    """Return all usable ids, in an order that depends on the workspace, the user and the machine."""
    identity = f"{socket.gethostname()}:{os.getuid()}:{workspace}"
    start = int.from_bytes(hashlib.sha256(identity.encode()).digest()[:8]) % len(USABLE_DOMAINS)
    return [*USABLE_DOMAINS[start:], *USABLE_DOMAINS[:start]]


def _choose(workspace: Path, others: list[Claim], in_use: Collection[int]) -> int:
    taken = {claim.domain for claim in others}
    free = [domain for domain in preferred_order(workspace) if domain not in taken]
    quiet = [domain for domain in free if domain not in in_use]
    if quiet or free:
        return (quiet or free)[0]
    last_used = {domain: max(claim.used_at for claim in others if claim.domain == domain) for domain in USABLE_DOMAINS}
    # More workspaces than domains: share the least recently used one.
    return min(USABLE_DOMAINS, key=last_used.__getitem__)


# --- the folder and its files ---


@contextmanager
def _open_folder(path: Path, *, create: bool = False) -> Iterator[int]:
    if create:
        with contextlib.suppress(FileExistsError):
            path.mkdir(mode=0o1777)
    fd = os.open(path, os.O_RDONLY | os.O_DIRECTORY | _SAFE_OPEN_FLAGS)
    try:
        status = os.fstat(fd)
        if create and status.st_uid == os.getuid() and stat.S_IMODE(status.st_mode) != 0o1777:
            os.fchmod(fd, 0o1777)  # regardless of the umask: every user may add claims, but change only their own
        yield fd
    finally:
        os.close(fd)


@contextmanager
def _locked(folder: int) -> Iterator[None]:
    fd = _open_lock_file(folder)
    try:
        if not stat.S_ISREG(os.fstat(fd).st_mode) or not lock(fd, _LOCK_TIMEOUT_S):
            raise TimeoutError
        yield
    finally:
        os.close(fd)


def _open_lock_file(folder: int) -> int:
    flags = os.O_RDONLY | os.O_NONBLOCK | _SAFE_OPEN_FLAGS
    try:
        return os.open("lock", flags, dir_fd=folder)
    except FileNotFoundError:
        pass
    # O_CREAT only if the file is missing: on another user's file the kernel refuses it (fs.protected_regular).
    with contextlib.suppress(FileExistsError):
        fd = os.open("lock", flags | os.O_CREAT | os.O_EXCL, 0o644, dir_fd=folder)
        os.fchmod(fd, 0o644)
        return fd
    return os.open("lock", flags, dir_fd=folder)


def _claim_file_name(workspace: Path) -> str:
    return f"{os.getuid()}-{hashlib.sha256(os.fsencode(workspace)).hexdigest()[:16]}"


def _read_claims(folder: int) -> list[Claim]:
    """Return the valid claims, after removing this user's expired ones."""
    claims = []
    for name in sorted(os.listdir(folder))[:_MAX_CLAIMS]:
        claim = _read(folder, name)
        if claim is None:
            continue
        if claim.uid == os.getuid() and _is_expired(claim):
            with contextlib.suppress(OSError):
                os.unlink(name, dir_fd=folder)
        else:
            claims.append(claim)
    return claims


def _is_expired(claim: Claim) -> bool:
    return not os.path.lexists(claim.workspace) and time.time() - claim.used_at > _CLAIM_LIFETIME_S


def _read(folder: int, name: str) -> Claim | None:
    owner, separator, _ = name.partition("-")
    if not separator or not owner.isdecimal():
        return None
    try:
        fd = os.open(name, os.O_RDONLY | os.O_NONBLOCK | _SAFE_OPEN_FLAGS, dir_fd=folder)
    except OSError:
        return None
    with os.fdopen(fd, "rb") as file:
        status = os.fstat(fd)
        if not stat.S_ISREG(status.st_mode) or status.st_uid != int(owner):
            return None
        try:
            claim = json.loads(file.read(_MAX_CLAIM_BYTES))
            domain, workspace = claim["domain"], claim["workspace"]
        except (OSError, ValueError, TypeError, KeyError, RecursionError):
            return None
    if type(domain) is not int or type(workspace) is not str:
        return None
    return Claim(domain, workspace, status.st_uid, status.st_mtime)


def _write(folder: int, workspace: Path, domain: int) -> None:
    name = _claim_file_name(workspace)
    temporary = f".{name}"
    with contextlib.suppress(FileNotFoundError):
        os.unlink(temporary, dir_fd=folder)
    fd = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _SAFE_OPEN_FLAGS, 0o644, dir_fd=folder)
    with os.fdopen(fd, "wb") as file:
        os.fchmod(fd, 0o644)
        file.write(json.dumps({"domain": domain, "workspace": str(workspace)}).encode("utf-8"))
    os.rename(temporary, name, src_dir_fd=folder, dst_dir_fd=folder)
