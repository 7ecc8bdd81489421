"""When a process has been started."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..events.process.process_started import ProcessStarted
from ..launch_context import LaunchContext
from ..some_entities_type import SomeEntitiesType
from .on_action_event_base import OnActionEventBase

if TYPE_CHECKING:
    from ..actions.execute_process import ExecuteProcess


class OnProcessStart(OnActionEventBase):
    """The target action's process runs; with no target, any process."""

    def __init__(
        self,
        *,
        target_action: Callable[[Any], bool] | ExecuteProcess | None = None,
        on_start: SomeEntitiesType | Callable[[ProcessStarted, LaunchContext], SomeEntitiesType | None] | None,
        **kwargs: Any,
    ) -> None:
        from ..actions.execute_process import ExecuteProcess

        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            target_action_cls=ExecuteProcess,
            **kwargs,
        )
