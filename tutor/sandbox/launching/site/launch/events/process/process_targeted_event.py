"""Events that ask something of a process."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import TYPE_CHECKING

from ...event import Event
from ...utilities.ensure_argument_type_impl import ensure_argument_type

if TYPE_CHECKING:
    from ...actions.execute_local import ExecuteLocal


class ProcessTargetedEvent(Event):
    """Meant for the processes that the matcher picks."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Callable[[ExecuteLocal], bool]) -> None:
        self._process_matcher = process_matcher

    @property
    def process_matcher(self) -> Callable[[ExecuteLocal], bool]:
        return self._process_matcher


class ShutdownProcess(ProcessTargetedEvent):
    """The process is to end: SIGINT, and more if that does not help."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """The process is to get a signal, given by number or by name."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: str | signal.Signals, process_matcher: Callable[[ExecuteLocal], bool]) -> None:
        super().__init__(process_matcher=process_matcher)
        ensure_argument_type(signal_number, (str, signal.Signals), "signal_number", "SignalProcess")
        self._signal = signal_number

    @property
    def signal(self) -> str | signal.Signals:
        return self._signal

    @property
    def signal_name(self) -> str:
        return self._signal if isinstance(self._signal, str) else self._signal.name
