"""What a process prints."""

from __future__ import annotations

from typing import Any

from .running_process_event import RunningProcessEvent


class ProcessIO(RunningProcessEvent):
    """Some bytes, as they came, from one of the three streams (`fd` 0, 1 or 2)."""

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
