"""Whether this machine can isolate submissions, and if not, why, and what to do: for `check`, `grade` and `doctor`."""

from __future__ import annotations

import json
import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from tutor import interpreter
from tutor.errors import EngineError

BWRAP = "/usr/bin/bwrap"
"""Where distributions install bubblewrap, and what the profile is for."""

_LIMIT_S = 30.0
_DENIED = re.compile("permission|not permitted", re.IGNORECASE)
_EXHAUSTED = re.compile("ENOSPC|no space left|exceeded", re.IGNORECASE)
_CONTAINER_FILES = (".dockerenv", "run/.containerenv", "run/systemd/container")
_PROFILE = "bwrap-userns-restrict"

_INSTALL = "install it: sudo apt install bubblewrap"
_LOAD = f"sudo apparmor_parser -r /etc/apparmor.d/{_PROFILE}"
_ALLOW_BWRAP = (
    "allow it to bubblewrap alone, with the profile that Ubuntu has for it: sudo apt install apparmor-profiles && "
    f"sudo install -m 644 /usr/share/apparmor/extra-profiles/{_PROFILE} /etc/apparmor.d/ && {_LOAD}"
)
_IN_CONTAINER = (
    "check outside of it, or let the container be the isolation: one for each submission, with nothing in it that a "
    "submission must not see"
)
_ELSEWHERE = "check on another machine, or as another user"


@dataclass(frozen=True, slots=True)
class NamespaceSupport:
    """What decides whether a program may make namespaces on this machine.

    `apparmor`: AppArmor forbids user namespaces to programs without a profile that allows them. `profile`: that for
    bubblewrap is there, loaded or not. `user_namespaces`: how many there may be; `for_all`: not only root may make one.
    `container`: this is one.
    """

    root: bool = False
    apparmor: bool = False
    profile: bool = False
    user_namespaces: int = 1
    for_all: bool = True
    container: bool = False

    @classmethod
    def read(cls, top: Path = Path("/")) -> NamespaceSupport:
        """Read it from /proc/sys and other files of the system below `top`."""
        sysctl = top / "proc" / "sys"
        return cls(
            root=os.geteuid() == 0,
            apparmor=_number(sysctl / "kernel" / "apparmor_restrict_unprivileged_userns", 0) != 0,
            profile=(top / "etc" / "apparmor.d" / _PROFILE).exists(),
            user_namespaces=_number(sysctl / "user" / "max_user_namespaces", 1),
            for_all=_number(sysctl / "kernel" / "unprivileged_userns_clone", 1) != 0,
            container=any((top / name).exists() for name in _CONTAINER_FILES),
        )


def why_not(said: str, support: NamespaceSupport, bwrap: str | None) -> EngineError:
    """Return why a machine cannot isolate submissions, with what to do, from what bubblewrap `said` when it failed."""
    if bwrap is None:
        return EngineError("isolation needs bubblewrap, which is not installed", _INSTALL)
    denied = _DENIED.search(said) is not None
    if not support.user_namespaces and (denied or _EXHAUSTED.search(said)):
        return EngineError(
            "user namespaces, which isolation needs, are disabled (user.max_user_namespaces is 0)",
            f"allow them: sudo sysctl user.max_user_namespaces=10000; or {_ELSEWHERE}",
        )
    if denied and support.container:
        return EngineError(f"this container may not isolate anything itself ({said})", _IN_CONTAINER)
    if denied and not support.root and not support.for_all:
        return EngineError(
            "user namespaces, which isolation needs, are disabled (kernel.unprivileged_userns_clone is 0)",
            f"allow them: sudo sysctl kernel.unprivileged_userns_clone=1; or {_ELSEWHERE}",
        )
    if denied and not support.root and support.apparmor:
        return EngineError(
            "AppArmor forbids bubblewrap to isolate anything (kernel.apparmor_restrict_unprivileged_userns is 1)",
            _apparmor_hint(support, bwrap),
        )
    return EngineError(f"bubblewrap cannot isolate anything here ({said})", _ELSEWHERE)


def try_isolation() -> EngineError | None:
    """Try to isolate something, in a process; return why that is impossible here, or None if it works."""
    argv = interpreter.module_command("tutor.engine", "--try-isolation")
    try:
        tried = subprocess.run(argv, capture_output=True, text=True, errors="replace", timeout=_LIMIT_S, check=False)
        problem = json.loads(tried.stdout) if tried.returncode else None
        return EngineError(problem["what"], problem["hint"]) if problem else None
    except (OSError, subprocess.TimeoutExpired, ValueError) as error:
        return EngineError(f"it cannot be tried ({error})")


def told(problem: EngineError) -> str:
    """Return what `try_isolation` reads in another process."""
    return json.dumps({"what": str(problem), "hint": problem.hint})


def _apparmor_hint(support: NamespaceSupport, bwrap: str) -> str:
    if bwrap != BWRAP:
        return f"its profile is for {BWRAP}, and this is {bwrap}: sudo apt install bubblewrap, and put /usr/bin first"
    return f"load its profile: {_LOAD}" if support.profile else _ALLOW_BWRAP


def _number(file: Path, otherwise: int) -> int:
    try:
        return int(file.read_text())
    except (OSError, ValueError):
        return otherwise
