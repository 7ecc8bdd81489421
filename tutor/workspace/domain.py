"""The ROS domain of a workspace. Each has its own, so that the nodes of two learners on one machine never meet.

It is saved in the workspace, in `.ros-tutor/domain`, and used for everything the learner runs; `ROS_DOMAIN_ID`
overrides it.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Mapping
from pathlib import Path

from tutor.errors import StorageError
from tutor.workspace import claims
from tutor.workspace.atomic import write_atomically
from tutor.workspace.layout import MARKER, Workspace

VARIABLE = "ROS_DOMAIN_ID"
_MAX_DOMAIN_ID = 232
"""The highest domain id for which DDS has port numbers."""


def domain_of(workspace: Workspace, environ: Mapping[str, str] = os.environ) -> int:
    """Return the ROS domain id for the nodes of `workspace`: `ROS_DOMAIN_ID` if set, else the workspace's own.

    On the first call, an id from 1 to 101 is chosen that no other workspace of this machine has claimed and no other
    participant uses, if possible. It stays the same unless a copy of the workspace has claimed it. `workspace` need not
    exist or be writable. Reads and writes the disk, which takes some milliseconds the first time. Never raises.
    """
    given = given_domain(environ)
    return _own_domain(Path(os.path.realpath(workspace.root))) if given is None else given


def given_domain(environ: Mapping[str, str] = os.environ) -> int | None:
    """Return the value of `ROS_DOMAIN_ID`; None if it is not set or not a valid id."""
    return _parse_domain_id(environ.get(VARIABLE, ""))


def _own_domain(root: Path) -> int:
    saved = _read_saved_domain(root)
    if saved is not None and claims.claimed_by(root, claims.REGISTRY) == saved:
        return saved
    chosen = claims.claim(root, lambda: _read_saved_domain(root), _in_use, claims.REGISTRY)
    if chosen is None:  # no registry: two workspaces collide with a probability of about 1 in 100
        chosen = claims.preferred_order(root)[0] if saved is None else saved
    if chosen != saved and os.path.isdir(root / MARKER):
        with contextlib.suppress(StorageError):
            write_atomically(root / MARKER / "domain", f"{chosen}\n")
    return chosen


def _read_saved_domain(root: Path) -> int | None:
    try:
        with (root / MARKER / "domain").open("rb") as file:
            return _parse_domain_id(file.read(64).decode("ascii"))
    except (OSError, ValueError):
        return None


def _in_use() -> frozenset[int]:
    from tutor.ros.domain import domains_in_use  # imported late: needed only once per workspace

    return domains_in_use()


def _parse_domain_id(text: str) -> int | None:
    text = text.strip()
    return int(text) if text.isascii() and text.isdecimal() and len(text) < 4 and int(text) <= _MAX_DOMAIN_ID else None
