"""Saves the learner's preferences in the workspace: shortly after each change, and on shutdown."""

from __future__ import annotations

import asyncio
import dataclasses
from typing import Any

from textual.timer import Timer

from tutor.errors import StorageError
from tutor.tui.control.host import HostScreen
from tutor.workspace import AppState

WRITE_DELAY_S = 0.3
"""Debounce: changes within this time are written together."""


class Preferences:
    """The only place that changes `model.state`."""

    def __init__(self, host: HostScreen) -> None:
        self._host = host
        self._timer: Timer | None = None
        self._write_lock = asyncio.Lock()
        self._saved = host.model.state

    def update(self, **changes: Any) -> None:
        """Change these fields of `AppState`."""
        self.replace(dataclasses.replace(self._host.model.state, **changes))

    def replace(self, state: AppState) -> None:
        """Replace the whole state."""
        model = self._host.model
        if state != model.state:
            model.state = state
            self._host.preferences_changed()
            if self._timer is None:
                self._timer = self._host.set_timer(WRITE_DELAY_S, self._write_due)

    def _write_due(self) -> None:
        self._timer = None
        self._host.start_worker(self.flush, group="state")

    async def flush(self) -> None:
        """Write the state now, if it has changed."""
        model = self._host.model
        async with self._write_lock:  # concurrent writes would remove each other's temporary file
            state = model.state
            if state == self._saved:
                return
            try:
                await asyncio.to_thread(model.session.save_app_state, state)
                self._saved = state
            except StorageError as error:
                self._saved = state  # report the error once, not on every change
                self._host.show_error(f"Your preferences could not be saved: {error}")
