"""What launch files are made of: entities, actions, conditions, substitutions, events and their handlers."""

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
    """A text that is known only while the launch file runs."""

    def describe(self) -> str:
        return repr(self)

    def perform(self, context: LaunchContext) -> str:
        """The text, in this context."""
        raise NotImplementedError(f"{type(self).__name__} has no perform()")


SomeSubstitutionsType = str | Path | Substitution | Iterable[str | Path | Substitution]
"""A text, a path, a substitution, or several of them to be joined."""

SomeSubstitutionsType_types_tuple = (str, Path, Substitution, collections.abc.Iterable)


class LaunchDescriptionEntity:
    """Something that is visited, in order, when a launch description runs."""

    def describe(self) -> str:
        raise NotImplementedError

    def describe_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """The entities that a visit of this one always brings."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """The entities that it may bring, each group with the condition in words."""
        return []

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Do what the entity does; the entities returned are visited next, before any other."""
        return None

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Done when nothing of this entity is going on any more; None where nothing ever was."""
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
    """Raised by perform()."""


class TextSubstitution(Substitution):
    """A text as it stands; TypeError for anything else."""

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
        """Whether the action is executed; raises where that cannot be known."""
        self._last_result = self._predicate(context) if self._predicate is not None else False
        return self._last_result

    def last_evaluation_result(self) -> bool | None:
        """What `evaluate` said last, None before the first time."""
        return self._last_result


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
        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None:
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))


class Event:
    """Something that has happened, or is asked for, while a launch file runs."""

    name = "launch.Event"


class ExecutionComplete(Event):
    """Nothing of the action is going on any more."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self._action = action

    @property
    def action(self) -> Action:
        return self._action


class BaseEventHandler:
    """Picks events with a matcher. The event is in `context.locals.event` of what it leads to."""

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
        """In words, and the entities that the handler may bring."""
        words = (
            f"{type(self).__name__}(matcher='{self.matcher_description}', "
            f"handler='{self.handler_description}', handle_once={self._handle_once})"
        )
        return words, []

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """What the event leads to; to be extended by those that derive from it."""
        context.extend_locals({"event": event})
        if self._handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """Leads to the same entities whenever an event matches."""

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
        words, entities = super().describe()
        if self._entities is not None:
            entities.extend(normalize_to_list_of_entities([self._entities]))
        return words, entities

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self._entities


class InvalidLaunchFileError(Exception):
    """No way of reading the file worked; `likely_errors` says why, way by way."""

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
