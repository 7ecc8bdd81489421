"""The base of what a process brings about."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...event import Event

if TYPE_CHECKING:
    from ...actions.execute_local import ExecuteLocal


class RunningProcessEvent(Event):
    """Something about a process that was started."""

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: ExecuteLocal,
        name: str,
        cmd: list[str],
        cwd: str | None,
        env: dict[str, str] | None,
        pid: int,
    ) -> None:
        self._action = action
        self._process_name = name
        self._cmd = cmd
        self._cwd = cwd
        self._env = env
        self._pid = pid

    @property
    def action(self) -> ExecuteLocal:
        return self._action

    @property
    def execute_process_action(self) -> ExecuteLocal:
        return self._action

    @property
    def process_name(self) -> str:
        return self._process_name

    @property
    def cmd(self) -> list[str]:
        return self._cmd

    @property
    def cwd(self) -> str | None:
        return self._cwd

    @property
    def env(self) -> dict[str, str] | None:
        return self._env

    @property
    def pid(self) -> int:
        return self._pid
