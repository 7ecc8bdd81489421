"""The ROS domain of a workspace: one of its own, so that two learners on one machine never meet.

It is kept in the workspace, in `.ros-tutor/domain`, and used by whatever the learner runs; `ROS_DOMAIN_ID` wins.
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
_LAST = 232
"""The last id that DDS has ports for."""


def domain_of(workspace: Workspace, environ: Mapping[str, str] = os.environ) -> int:
    """The id of the ROS domain in which the nodes of `workspace` run: what `ROS_DOMAIN_ID` says, else its own.

    The first time, an id (1 to 101) is chosen that no other workspace of this machine has and nothing else uses; from
    then on it is the same one, unless a copy of the workspace has it. `workspace` need not exist, or be writable.
    Reads and writes the disk: some milliseconds the first time. Raises nothing.
    """
    given = given_domain(environ)
    return _own(Path(os.path.realpath(workspace.root))) if given is None else given


def given_domain(environ: Mapping[str, str] = os.environ) -> int | None:
    """What `ROS_DOMAIN_ID` says; None where it is not set, or not to a number."""
    return _number(environ.get(VARIABLE, ""))


def _own(root: Path) -> int:
    kept = _kept(root)
    if kept is not None and claims.claimed_by(root, claims.REGISTRY) == kept:
        return kept
    chosen = claims.claim(root, lambda: _kept(root), _in_use, claims.REGISTRY)
    if chosen is None:  # no registry: the odds are a hundred to one that nobody has the same
        chosen = claims.preferred(root)[0] if kept is None else kept
    if chosen != kept and os.path.isdir(root / MARKER):
        with contextlib.suppress(StorageError):
            write_atomically(root / MARKER / "domain", f"{chosen}\n")
    return chosen


def _kept(root: Path) -> int | None:
    try:
        with (root / MARKER / "domain").open("rb") as file:
            return _number(file.read(64).decode("ascii"))
    except (OSError, ValueError):
        return None


def _in_use() -> frozenset[int]:
    from tutor.ros.domain import domains_in_use  # late: needed once in the life of a workspace

    return domains_in_use()


def _number(text: str) -> int | None:
    text = text.strip()
    return int(text) if text.isascii() and text.isdecimal() and len(text) < 4 and int(text) <= _LAST else None
