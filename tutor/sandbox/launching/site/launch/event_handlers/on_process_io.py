"""When a process prints."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..events.process.process_io import ProcessIO
from ..launch_context import LaunchContext
from ..some_entities_type import SomeEntitiesType
from .on_action_event_base import OnActionEventBase

if TYPE_CHECKING:
    from ..actions.execute_local import ExecuteLocal

    Listener = Callable[[ProcessIO], SomeEntitiesType | None]


class OnProcessIO(OnActionEventBase):
    """The target action's process has printed something; with no target, any process."""

    def __init__(
        self,
        *,
        target_action: Callable[[Any], bool] | ExecuteLocal | None = None,
        on_stdin: Listener | None = None,
        on_stdout: Listener | None = None,
        on_stderr: Listener | None = None,
        **kwargs: Any,
    ) -> None:
        from ..actions.execute_local import ExecuteLocal

        def pass_on(event: ProcessIO, context: LaunchContext) -> SomeEntitiesType | None:
            listener = on_stdout if event.from_stdout else on_stderr if event.from_stderr else on_stdin
            return listener(event) if listener is not None else None

        super().__init__(
            action_matcher=target_action,
            on_event=pass_on,
            target_event_cls=ProcessIO,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )
