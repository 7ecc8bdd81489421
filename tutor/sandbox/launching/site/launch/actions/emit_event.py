"""An event."""

from __future__ import annotations

from typing import Any

from ..action import Action
from ..event import Event
from ..launch_context import LaunchContext
from ..utilities.class_tools_impl import is_a_subclass


class EmitEvent(Action):
    """Emits the event."""

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not is_a_subclass(event, Event):
            raise RuntimeError(f"EmitEvent() expected an event instance, got '{event}'.")
        self._event = event

    @property
    def event(self) -> Event:
        return self._event

    def execute(self, context: LaunchContext) -> None:
        context.emit_event_sync(self._event)
