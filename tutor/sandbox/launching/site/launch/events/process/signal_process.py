"""A process is to get a signal."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import TYPE_CHECKING

from ...utilities.ensure_argument_type_impl import ensure_argument_type
from .process_targeted_event import ProcessTargetedEvent

if TYPE_CHECKING:
    from ...actions.execute_local import ExecuteLocal


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
