"""Keeps in the workspace what the learner chose: written soon after each change, and when they leave."""

from __future__ import annotations

import asyncio
import dataclasses
from typing import Any

from textual.timer import Timer

from tutor.tui.screens.stage import Stage
from tutor.workspace import AppState, StorageError

WRITE_AFTER_S = 0.3


class Memory:
    """The only one that changes `session.state`."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._timer: Timer | None = None
        self._writing = asyncio.Lock()
        self._kept = stage.session.state

    def note(self, **changes: Any) -> None:
        """Remember these fields of `AppState`."""
        self.put(dataclasses.replace(self._stage.session.state, **changes))

    def put(self, state: AppState) -> None:
        """Remember this state."""
        session = self._stage.session
        if state != session.state:
            session.state = state
            self._stage.remembered()
            if self._timer is None:
                self._timer = self._stage.set_timer(WRITE_AFTER_S, self._due)

    def _due(self) -> None:
        self._timer = None
        self._stage.work(self.flush, group="state")

    async def flush(self) -> None:
        """Write it now, if anything has changed."""
        session = self._stage.session
        async with self._writing:  # two writes at once would take each other's temporary file away
            state = session.state
            if state == self._kept:
                return
            try:
                await asyncio.to_thread(session.desk.keep, state)
                self._kept = state
            except StorageError as error:
                self._kept = state  # told once, not at every change
                self._stage.trouble(f"The app cannot remember this: {error}")
