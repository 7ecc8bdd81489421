"""The building blocks of launch files: entities, actions, conditions, substitutions, events and event handlers."""

from __future__ import annotations

import asyncio
import collections.abc
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from . import _tracebacks

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Substitution:
    """A text that is not known until the launch file runs."""

    def describe(self) -> str:
        return repr(self)

    def perform(self, context: LaunchContext) -> str:
        """Return the text in this context."""
        raise NotImplementedError(f"{type(self).__name__} has no perform()")


SomeSubstitutionsType = str | Path | Substitution | Iterable[str | Path | Substitution]
"""A text, a path or a substitution, or several of these, which are concatenated."""

SomeSubstitutionsType_types_tuple = (str, Path, Substitution, collections.abc.Iterable)


class LaunchDescriptionEntity:
    """Something that is visited, in order, when a launch description runs."""

    def describe(self) -> str:
        raise NotImplementedError

    def describe_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """Return the entities that visiting this one always yields."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the entities that it may yield, grouped by a description of their condition."""
        return []

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Perform the entity's effect. The returned entities are visited next, before any others."""
        return None

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return a future that is done once the entity has finished; None if it has nothing to wait for."""
        return None


SomeEntitiesType = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
"""One entity or several."""

SomeEntitiesType_types_tuple = (LaunchDescriptionEntity, collections.abc.Iterable)


def normalize_to_list_of_entities(entities: Iterable[SomeEntitiesType]) -> list[LaunchDescriptionEntity]:
    """Flatten one level of lists."""
    flat: list[LaunchDescriptionEntity] = []
    for item in entities:
        flat.extend([item] if isinstance(item, LaunchDescriptionEntity) else item)
    return flat


class SubstitutionFailure(RuntimeError):  # noqa: N818, RUF100 - the original's name
    """A substitution cannot be performed."""


class TextSubstitution(Substitution):
    """A literal text. Raises TypeError for anything else."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expected Text object got '{type(text)}' instead.")
        self._text = text

    @property
    def text(self) -> str:
        return self._text

    def describe(self) -> str:
        return f"'{self._text}'"

    def perform(self, context: LaunchContext) -> str:
        return self._text


class Condition:
    """Decides whether an action is executed."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate
        self._last_result: bool | None = None

    def describe(self) -> str:
        return repr(self)

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether the action is executed. Raises if the condition cannot be evaluated."""
        self._last_result = self._predicate(context) if self._predicate is not None else False
        return self._last_result

    def last_evaluation_result(self) -> bool | None:
        """Return the last result of `evaluate`; None before its first call."""
        return self._last_result


class Action(LaunchDescriptionEntity):
    """An intention to do something, optionally under a condition."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        self._condition = condition
        self._created_at = _tracebacks.learner_location()

    @property
    def condition(self) -> Condition | None:
        return self._condition

    def describe(self) -> str:
        return repr(self)

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """Return the entities nested in this action."""
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
            _tracebacks.note_location(error, self._created_at)
            raise

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Carry out the action. The returned entities are visited next."""
        return None

    def _report_completion(self, context: LaunchContext) -> None:
        """Emit ExecutionComplete once the action has finished, if a handler wants it."""
        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None:
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))


class Event:
    """Something that has happened or is requested while a launch file runs."""

    name = "launch.Event"


class ExecutionComplete(Event):
    """The action has finished."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self._action = action

    @property
    def action(self) -> Action:
        return self._action


class BaseEventHandler:
    """Handles the events that a matcher accepts. The resulting entities see the event as `context.locals.event`."""

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self._matcher = matcher
        self._handle_once = handle_once

    @property
    def handle_once(self) -> bool:
        return self._handle_once

    @property
    def handler_description(self) -> str | None:
        return None

    @property
    def matcher_description(self) -> str | None:
        return None

    def matches(self, event: Event) -> bool:
        return self._matcher(event)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description and the entities that the handler may yield."""
        description = (
            f"{type(self).__name__}(matcher='{self.matcher_description}', "
            f"handler='{self.handler_description}', handle_once={self._handle_once})"
        )
        return description, []

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Handle the event and return the resulting entities. Subclasses extend this method."""
        context.extend_locals({"event": event})
        if self._handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """Yields the same entities whenever an event matches."""

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self._entities = entities

    @property
    def entities(self) -> SomeEntitiesType | None:
        return self._entities

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        description, entities = super().describe()
        if self._entities is not None:
            entities.extend(normalize_to_list_of_entities([self._entities]))
        return description, entities

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self._entities


class InvalidLaunchFileError(Exception):
    """The file could not be read in any format; `likely_errors` holds one error per attempt."""

    def __init__(self, extension: str = "", *, likely_errors: Sequence[Exception] = ()) -> None:
        super().__init__(extension)
        if not extension or not likely_errors:
            self._message = "The launch file may have a syntax error, or its format is unknown"
            return
        count = "multiple exceptions" if len(likely_errors) > 1 else "exception"
        lines = [f"Caught {count} when trying to load file of format [{extension}]:"]
        lines += [f" - {type(error).__name__}: {error}" for error in likely_errors]
        self._message = "\n".join(lines)
        self.__cause__ = likely_errors[0]

    def __str__(self) -> str:
        return self._message
