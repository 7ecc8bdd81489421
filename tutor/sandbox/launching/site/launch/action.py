"""The base of all actions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from . import _tracebacks
from .launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from .condition import Condition
    from .launch_context import LaunchContext


class Action(LaunchDescriptionEntity):
    """An intention to do something, which a condition may prevent."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        self._condition = condition
        self._place = _tracebacks.place_of_caller()

    @property
    def condition(self) -> Condition | None:
        return self._condition

    def describe(self) -> str:
        return repr(self)

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """The entities inside this action."""
        return []

    def describe_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self.get_sub_entities() if self._condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        if self._condition is None:
            return []
        return [(f"Conditionally included by {self.describe()}", self.get_sub_entities())]

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        try:
            if self._condition is not None and not self._condition.evaluate(context):
                return None
            try:
                return self.execute(context)
            finally:
                self._report_completion(context)
        except Exception as error:
            _tracebacks.note_place(error, self._place)
            raise

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Do it; the entities returned are visited next."""
        return None

    def _report_completion(self, context: LaunchContext) -> None:
        """Emit ExecutionComplete, once nothing of this action is going on, if anybody listens."""
        from .events.execution_complete import ExecutionComplete

        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None:
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))
