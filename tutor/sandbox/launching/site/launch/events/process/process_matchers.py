"""Matchers for processes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...actions.execute_local import ExecuteLocal


def matches_pid(pid: int) -> Callable[[ExecuteLocal], bool]:
    """True for the process with this id."""
    return lambda action: action.process_details is not None and action.process_details.get("pid") == pid


def matches_name(name: str) -> Callable[[ExecuteLocal], bool]:
    """True for the process of this name, `talker-1` for instance."""
    return lambda action: action.process_details is not None and action.process_details["name"] == name


def matches_executable(executable: str) -> Callable[[ExecuteLocal], bool]:
    """True for processes whose executable's path ends like this."""

    def matches(action: ExecuteLocal) -> bool:
        return action.process_details is not None and str(action.process_details["cmd"][0]).endswith(executable)

    return matches
