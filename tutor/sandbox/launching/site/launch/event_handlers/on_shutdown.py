"""When all is to end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..event import Event
from ..event_handler import BaseEventHandler
from ..events.shutdown import Shutdown
from ..launch_context import LaunchContext
from ..some_entities_type import SomeEntitiesType
from ..utilities.class_tools_impl import is_a_subclass


class OnShutdown(BaseEventHandler):
    """The launch is ending: by Ctrl+C, by a Shutdown, by an error, or because nothing is going on."""

    def __init__(
        self,
        *,
        on_shutdown: SomeEntitiesType | Callable[[Shutdown, LaunchContext], SomeEntitiesType | None],
        **kwargs: Any,
    ) -> None:
        super().__init__(matcher=lambda event: is_a_subclass(event, Shutdown), **kwargs)
        self._on_shutdown = on_shutdown

    @property
    def matcher_description(self) -> str:
        return "event issubclass of launch.events.Shutdown"

    @property
    def handler_description(self) -> str:
        return str(self._on_shutdown)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        if callable(self._on_shutdown):
            assert isinstance(event, Shutdown)
            return self._on_shutdown(event, context)
        return self._on_shutdown
