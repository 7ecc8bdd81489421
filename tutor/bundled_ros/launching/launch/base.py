"""The abstract parts of launch files, and the context in which they act: the state of a running launch file."""

from __future__ import annotations

import asyncio
import collections.abc
import os
from collections import deque
from collections.abc import Callable, Iterable, Mapping, MutableMapping, Sequence
from pathlib import Path
from typing import Any

from tutor.bundled_ros.launching.launch.logs import get_logger
from tutor.bundled_ros.launching.launch.subprocesses import Process


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


class Event:
    """Something that has happened or is requested while a launch file runs."""

    name = "launch.Event"


class BaseEventHandler:
    """Handles the events that a matcher accepts. The resulting entities see the event as `context.locals.event`."""

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self._matcher = matcher
        self._handle_once = handle_once

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


class Locals:
    """A read-only view of the context's locals as attributes."""

    def __init__(self, members: Mapping[str, Any]) -> None:
        object.__setattr__(self, "_members", members)

    def __getattr__(self, name: str) -> Any:
        members: Mapping[str, Any] = object.__getattribute__(self, "_members")
        try:
            return members[name]
        except KeyError:
            known = ", ".join(members)
            raise AttributeError(
                f"context.locals does not contain attribute '{name}', it contains: [{known}]"
            ) from None

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"can't set attribute '{name}', locals are read-only")


class LaunchContext:
    """Launch configurations, environment, locals, event handlers and queued events.

    The environment is that of this process: processes that are started later inherit changes to it.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self._argv = list(argv) if argv is not None else []
        self._noninteractive = noninteractive
        self._event_queue: asyncio.Queue[Event] = asyncio.Queue()
        self._event_handlers: deque[BaseEventHandler] = deque()
        self._completion_futures: list[asyncio.Future[None]] = []
        self._globals: dict[str, Any] = {}
        self._locals: dict[str, Any] = {}
        self._locals_stack: list[dict[str, Any]] = []
        self._configurations: dict[str, Any] = {}
        self._configurations_stack: list[dict[str, Any]] = []
        self._environment_at_start = dict(os.environ)
        self._environment_stack: list[dict[str, str]] = []
        self._is_shutdown = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._processes: set[Process] = set()
        self._start_cancellers: list[Callable[[], None]] = []

    @property
    def argv(self) -> list[str]:
        return self._argv

    @property
    def noninteractive(self) -> bool:
        """Whether there is no terminal, so that only we can pass Ctrl+C on to the processes."""
        return self._noninteractive

    @property
    def is_shutdown(self) -> bool:
        return self._is_shutdown

    def _set_is_shutdown(self, state: bool) -> None:
        self._is_shutdown = state

    @property
    def asyncio_loop(self) -> asyncio.AbstractEventLoop:
        """The event loop that runs the launch file. Raises RuntimeError unless it is running."""
        if self._loop is None:
            raise RuntimeError("the launch file is not running")
        return self._loop

    def _set_asyncio_loop(self, loop: asyncio.AbstractEventLoop | None) -> None:
        self._loop = loop

    def add_completion_future(self, completion_future: asyncio.Future[None]) -> None:
        """Keep the launch running until this future is done."""
        self._completion_futures.append(completion_future)

    # --- locals: visible only to the entities that result from one event or file

    @property
    def locals(self) -> Locals:
        return Locals(self.get_locals_as_dict())

    def get_locals_as_dict(self) -> dict[str, Any]:
        return {**self._globals, **self._locals}

    def extend_globals(self, extensions: Mapping[str, Any]) -> None:
        """Add locals for the rest of the launch."""
        self._globals.update(extensions)

    def extend_locals(self, extensions: Mapping[str, Any]) -> None:
        """Add locals for the event that is being handled."""
        self._locals.update(extensions)

    def _push_locals(self) -> None:
        self._locals_stack.append(dict(self._locals))

    def _pop_locals(self) -> None:
        self._locals = self._pop(self._locals_stack, "locals")

    # --- launch configurations

    @property
    def launch_configurations(self) -> dict[str, Any]:
        return self._configurations

    def _push_launch_configurations(self) -> None:
        self._configurations_stack.append(dict(self._configurations))

    def _pop_launch_configurations(self) -> None:
        self._configurations = self._pop(self._configurations_stack, "launch_configurations")

    # --- environment

    @property
    def environment(self) -> MutableMapping[str, str]:
        return os.environ

    def _push_environment(self) -> None:
        self._environment_stack.append(dict(os.environ))

    def _pop_environment(self) -> None:
        before = self._pop(self._environment_stack, "environment")
        self._restore_environment(before)

    def _reset_environment(self) -> None:
        self._restore_environment(self._environment_at_start)

    @staticmethod
    def _restore_environment(environment: Mapping[str, str]) -> None:
        # Changed in place: os.environ updates the C library's environment, which child processes inherit.
        os.environ.clear()
        os.environ.update(environment)

    @staticmethod
    def _pop[T](stack: list[T], what: str) -> T:
        if not stack:
            raise RuntimeError(f"{what} stack unexpectedly empty")
        return stack.pop()

    # --- events

    def would_handle_event(self, event: Event) -> bool:
        return any(handler.matches(event) for handler in self._event_handlers)

    def register_event_handler(self, event_handler: BaseEventHandler, append: bool = False) -> None:
        """Add a handler before all others, or with `append` after them."""
        if append:
            self._event_handlers.append(event_handler)
        else:
            self._event_handlers.appendleft(event_handler)

    def unregister_event_handler(self, event_handler: BaseEventHandler) -> None:
        """Remove a handler. Raises ValueError if it is not registered."""
        self._event_handlers.remove(event_handler)

    def emit_event_sync(self, event: Event) -> None:
        """Queue an event."""
        self._queue(event, "emitting event synchronously")

    async def emit_event(self, event: Event) -> None:
        """Queue an event."""
        self._queue(event, "emitting event")

    def _queue(self, event: Event, how: str) -> None:
        get_logger("launch.launch_context").debug(f"{how}: '{event.name}'")
        self._event_queue.put_nowait(event)

    def perform_substitution(self, substitution: Substitution) -> str:
        return substitution.perform(self)
