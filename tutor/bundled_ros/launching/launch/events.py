"""Events, including those of processes."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any

from tutor.bundled_ros.launching.launch.base import Event, LaunchDescriptionEntity
from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.values import ensure_argument_type


class IncludeLaunchDescription(Event):
    """Requests a visit of a launch description."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: LaunchDescriptionEntity) -> None:
        self._description = launch_description

    @property
    def launch_description(self) -> LaunchDescriptionEntity:
        return self._description


class Shutdown(Event):
    """The launch shuts down. `due_to_sigint`: because of Ctrl+C, which the terminal has sent to the processes, too."""

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self._reason = reason
        self._due_to_sigint = due_to_sigint

    @property
    def reason(self) -> str:
        return self._reason

    @property
    def due_to_sigint(self) -> bool:
        return self._due_to_sigint


def matches_action(target_action: Action) -> Callable[[Action], bool]:
    """Return a matcher for exactly this action."""
    return lambda action: action is target_action


class RunningProcessEvent(Event):
    """An event of a process that was started."""

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: Action,
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
    def action(self) -> Action:
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


class ProcessStarted(RunningProcessEvent):
    """The process has been started."""

    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """The process has ended. Return code -N: it was killed by signal N."""

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._returncode = returncode

    @property
    def returncode(self) -> int:
        return self._returncode


class ProcessIO(RunningProcessEvent):
    """Raw bytes of one of the standard streams (`fd` 0, 1 or 2)."""

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._text = text
        self._fd = fd

    @property
    def text(self) -> bytes:
        return self._text

    @property
    def from_stdin(self) -> bool:
        return self._fd == 0

    @property
    def from_stdout(self) -> bool:
        return self._fd == 1

    @property
    def from_stderr(self) -> bool:
        return self._fd == 2


class ProcessStdout(ProcessIO):
    """Bytes from the process's stdout."""

    name = "launch.events.process.ProcessStdout"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=1, **kwargs)


class ProcessStderr(ProcessIO):
    """Bytes from the process's stderr."""

    name = "launch.events.process.ProcessStderr"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=2, **kwargs)


class ProcessTargetedEvent(Event):
    """An event for the processes that the matcher accepts."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self._process_matcher = process_matcher

    @property
    def process_matcher(self) -> Callable[[Any], bool]:
        return self._process_matcher


class SignalProcess(ProcessTargetedEvent):
    """Requests that the process is sent a signal, given by number or by name."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: str | signal.Signals, process_matcher: Callable[[Any], bool]) -> None:
        super().__init__(process_matcher=process_matcher)
        ensure_argument_type(signal_number, (str, signal.Signals), "signal_number", "SignalProcess")
        self._signal = signal_number

    @property
    def signal(self) -> str | signal.Signals:
        return self._signal

    @property
    def signal_name(self) -> str:
        return self._signal if isinstance(self._signal, str) else self._signal.name


class ShutdownProcess(ProcessTargetedEvent):
    """Requests that the process ends: SIGINT, then SIGTERM and SIGKILL if it does not."""

    name = "launch.events.process.ShutdownProcess"
