"""Event handlers, except those of processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from tutor.bundled_ros.launching.launch.base import (
    BaseEventHandler,
    Event,
    LaunchContext,
    LaunchDescriptionEntity,
    SomeEntitiesType,
)
from tutor.bundled_ros.launching.launch.entities import Action, ExecutionComplete
from tutor.bundled_ros.launching.launch.events import IncludeLaunchDescription, Shutdown
from tutor.bundled_ros.launching.launch.values import is_a_subclass


def event_named(name: str) -> Callable[[Event], bool]:
    """Return a matcher for events of this name."""
    return lambda event: event.name == name


class OnActionEventBase(BaseEventHandler):
    """Handles events of one class that come from one action, from actions that a matcher accepts, or (None) from any.

    `on_event` is the resulting entities, or a callable that returns them for the event and the context.
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
        self._matcher_description = f"event == {target_event_cls.__name__}{from_action}"
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
        return self._matcher_description

    @property
    def handler_description(self) -> str:
        return "<actions>" if self._entities else str(self._callable)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        description, entities = super().describe()
        return description, [*entities, *self._entities]

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self._callable(event, context) if self._callable is not None else self._entities


class OnExecutionComplete(OnActionEventBase):
    """The target action (None: any action) has finished."""

    def __init__(
        self,
        *,
        target_action: Callable[[Any], bool] | Action | None = None,
        on_completion: SomeEntitiesType | Callable[[ExecutionComplete, LaunchContext], SomeEntitiesType | None],
        **kwargs: Any,
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_completion,
            target_event_cls=ExecutionComplete,
            target_action_cls=Action,
            **kwargs,
        )


class OnIncludeLaunchDescription(BaseEventHandler):
    """Visits the event's launch description."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, IncludeLaunchDescription), **kwargs)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        assert isinstance(event, IncludeLaunchDescription)
        return event.launch_description


class OnShutdown(BaseEventHandler):
    """The launch is shutting down: after Ctrl+C, a Shutdown action or an error, or because nothing is left to do."""

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
