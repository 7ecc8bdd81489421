"""The base of handlers for what becomes of an action."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from ..action import Action
from ..event import Event
from ..event_handler import BaseEventHandler
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_entities_type import SomeEntitiesType


class OnActionEventBase(BaseEventHandler):
    """Picks the events of one class that come from one action, from those a matcher picks, or (None) from any.

    What the event leads to are entities, or what a callable returns that is given event and context.
    """

    def __init__(
        self,
        *,
        action_matcher: Callable[[Any], bool] | Action | None,
        on_event: SomeEntitiesType | Callable[[Any, LaunchContext], SomeEntitiesType | None] | None,
        target_event_cls: type[Event],
        target_action_cls: type[Action],
        **kwargs: Any,
    ) -> None:
        is_action = isinstance(action_matcher, target_action_cls)
        if action_matcher is not None and not is_action and not callable(action_matcher):
            raise TypeError(f"action_matcher must be an '{target_action_cls.__name__}' instance or a callable")

        def matches(event: Event) -> bool:
            if not isinstance(event, target_event_cls):
                return False
            action = getattr(event, "action", None)
            if action_matcher is None:
                return True
            return action_matcher(action) if callable(action_matcher) else action is action_matcher

        super().__init__(matcher=matches, **kwargs)
        from_action = "" if action_matcher is None else f" and {target_action_cls.__name__}(event.action)"
        self._matcher_words = f"event == {target_event_cls.__name__}{from_action}"
        self._callable: Callable[[Any, LaunchContext], SomeEntitiesType | None] | None = None
        self._entities: list[LaunchDescriptionEntity] = []
        if callable(on_event):
            self._callable = on_event
        elif isinstance(on_event, LaunchDescriptionEntity):
            self._entities = [on_event]
        elif isinstance(on_event, Iterable):
            self._entities = list(on_event)
            for item in self._entities:
                if not isinstance(item, LaunchDescriptionEntity):
                    raise TypeError(
                        "expected all items in 'on_event' iterable to be of type 'LaunchDescriptionEntity' "
                        f"but got '{type(item)}'"
                    )
        elif on_event is not None:
            raise TypeError(f"expected actions or a callable for an event, got '{type(on_event)}'")

    @property
    def matcher_description(self) -> str:
        return self._matcher_words

    @property
    def handler_description(self) -> str:
        return "<actions>" if self._entities else str(self._callable)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        words, entities = super().describe()
        return words, [*entities, *self._entities]

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self._callable(event, context) if self._callable is not None else self._entities
