"""Keeps in the workspace what the learner chose: written soon after each change, and when they leave."""

from __future__ import annotations

import asyncio
import dataclasses
from typing import Any

from textual.timer import Timer

from tutor.errors import StorageError
from tutor.tui.control.host import HostScreen
from tutor.workspace import AppState

WRITE_AFTER_S = 0.3


class Preferences:
    """The only one that changes `model.state`."""

    def __init__(self, host: HostScreen) -> None:
        self._host = host
        self._timer: Timer | None = None
        self._writing = asyncio.Lock()
        self._kept = host.model.state

    def update(self, **changes: Any) -> None:
        """Remember these fields of `AppState`."""
        self.replace(dataclasses.replace(self._host.model.state, **changes))

    def replace(self, state: AppState) -> None:
        """Remember this state."""
        model = self._host.model
        if state != model.state:
            model.state = state
            self._host.preferences_changed()
            if self._timer is None:
                self._timer = self._host.set_timer(WRITE_AFTER_S, self._due)

    def _due(self) -> None:
        self._timer = None
        self._host.work(self.flush, group="state")

    async def flush(self) -> None:
        """Write it now, if anything has changed."""
        model = self._host.model
        async with self._writing:  # two writes at once would take each other's temporary file away
            state = model.state
            if state == self._kept:
                return
            try:
                await asyncio.to_thread(model.session.keep, state)
                self._kept = state
            except StorageError as error:
                self._kept = state  # reported once, not at every change
                self._host.show_error(f"The app cannot remember this: {error}")
