"""Actions that emit events, register handlers, wait, call functions, log, and shut down."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Iterable, Sequence
from typing import Any

from tutor.bundled_ros.launching.launch import events
from tutor.bundled_ros.launching.launch.base import (
    BaseEventHandler,
    Event,
    LaunchContext,
    LaunchDescriptionEntity,
    SomeEntitiesType,
    SomeSubstitutionsType,
    Substitution,
)
from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.handlers import OnShutdown
from tutor.bundled_ros.launching.launch.logs import get_logger
from tutor.bundled_ros.launching.launch.scope import PopLaunchConfigurations
from tutor.bundled_ros.launching.launch.values import (
    ensure_argument_type,
    is_a_subclass,
    normalize_to_list_of_substitutions,
    normalize_typed_substitution,
    perform_substitutions,
    perform_typed_substitution,
)


class EmitEvent(Action):
    """Emits an event."""

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


class RegisterEventHandler(Action):
    """Registers an event handler."""

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._event_handler = event_handler

    @property
    def event_handler(self) -> BaseEventHandler:
        return self._event_handler

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        description, entities = self._event_handler.describe()
        return [(description, entities)] if entities else []

    def execute(self, context: LaunchContext) -> None:
        context.register_event_handler(self._event_handler)


class UnregisterEventHandler(Action):
    """Removes an event handler."""

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        context.unregister_event_handler(self._event_handler)


class TimerEvent(Event):
    """The period of a TimerAction has elapsed."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: TimerAction) -> None:
        self._timer_action = timer_action

    @property
    def timer_action(self) -> TimerAction:
        return self._timer_action


class _OnTimer(BaseEventHandler):
    """Visits the actions of the timer that has fired, with the locals and launch configurations of its start."""

    def __init__(self) -> None:
        super().__init__(matcher=lambda event: isinstance(event, TimerEvent))

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        assert isinstance(event, TimerEvent)
        return event.timer_action.handle(context)


class TimerAction(Action):
    """Visits actions after `period` seconds, unless the timer is cancelled or the launch shuts down first.

    The actions see the launch configurations as they were when the timer started, in a scope of their own.
    """

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        ensure_argument_type(period, (str, Substitution, Iterable, float, int), "period", "TimerAction")
        ensure_argument_type(actions, Iterable, "actions", "TimerAction")
        self._period = normalize_typed_substitution(float(period) if isinstance(period, str | int) else period, float)
        self._actions = list(actions)
        self._cancel_on_shutdown = normalize_typed_substitution(cancel_on_shutdown, bool)
        self._locals: dict[str, Any] = {}
        self._configurations: dict[str, Any] = {}
        self._is_cancelled = False
        self._cancelled: asyncio.Future[None] | None = None
        self._completed: asyncio.Future[None] | None = None

    def describe(self) -> str:
        return f"TimerAction(period={self._period}, actions=<actions>)"

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        return [(f"{self._period} seconds pass without being canceled", self._actions)]

    def cancel(self) -> None:
        """Cancel the timer, unless it has already fired."""
        self._is_cancelled = True
        if self._cancelled is not None and not self._cancelled.done():
            self._cancelled.set_result(None)

    def handle(self, context: LaunchContext) -> SomeEntitiesType | None:
        context.extend_locals(self._locals)
        context._push_launch_configurations()
        context.launch_configurations.clear()
        context.launch_configurations.update(self._configurations)
        return [*self._actions, PopLaunchConfigurations()]

    def execute(self, context: LaunchContext) -> None:
        loop = context.asyncio_loop
        self._completed = loop.create_future()
        self._cancelled = loop.create_future()
        if self._is_cancelled:
            self._completed.set_result(None)
            return
        if not any(isinstance(handler, _OnTimer) for handler in context._event_handlers):
            context.register_event_handler(_OnTimer())
        self._locals = context.get_locals_as_dict()
        self._configurations = dict(context.launch_configurations)
        period = perform_typed_substitution(context, self._period, float)
        task = loop.create_task(self._wait(context, period, self._cancelled, self._completed))
        self._completed.add_done_callback(lambda _: task.done())  # keeps the task alive as long as the future
        if perform_typed_substitution(context, self._cancel_on_shutdown, bool):
            on_shutdown: Callable[..., None] = lambda event, context: self.cancel()  # noqa: E731
            context.register_event_handler(OnShutdown(on_shutdown=on_shutdown))

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return self._completed

    async def _wait(
        self,
        context: LaunchContext,
        period: float,
        cancelled: asyncio.Future[None],
        completed: asyncio.Future[None],
    ) -> None:
        await asyncio.wait([cancelled], timeout=period)
        if not cancelled.done():
            context.emit_event_sync(TimerEvent(timer_action=self))
        completed.set_result(None)


class OpaqueFunction(Action):
    """Calls a function with the context and the arguments; the entities that it returns are visited next."""

    def __init__(
        self,
        *,
        function: Callable[..., Sequence[LaunchDescriptionEntity] | None],
        args: Iterable[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not callable(function):
            raise TypeError(f"OpaqueFunction expected a callable for 'function', got '{type(function)}'")
        ensure_argument_type(args, (Iterable, type(None)), "args", "OpaqueFunction")
        ensure_argument_type(kwargs, (dict, type(None)), "kwargs", "OpaqueFunction")
        self._function = function
        self._args = list(args or ())
        self._kwargs = dict(kwargs or {})

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        return self._function(context, *self._args, **self._kwargs)


class OpaqueCoroutine(Action):
    """Runs a coroutine function in the launch's event loop. It is cancelled at shutdown."""

    def __init__(
        self,
        *,
        coroutine: Callable[..., Coroutine[Any, Any, None]],
        args: Iterable[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        ignore_context: bool = False,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        if not asyncio.iscoroutinefunction(coroutine):
            raise TypeError(f"OpaqueCoroutine expected a coroutine function for 'coroutine', got '{type(coroutine)}'")
        ensure_argument_type(args, (Iterable, type(None)), "args", "OpaqueCoroutine")
        ensure_argument_type(kwargs, (dict, type(None)), "kwargs", "OpaqueCoroutine")
        ensure_argument_type(ignore_context, bool, "ignore_context", "OpaqueCoroutine")
        self._coroutine = coroutine
        self._args = list(args or ())
        self._kwargs = dict(kwargs or {})
        self._ignore_context = ignore_context
        self._task: asyncio.Task[None] | None = None

    def execute(self, context: LaunchContext) -> None:
        first = () if self._ignore_context else (context,)
        self._task = context.asyncio_loop.create_task(self._coroutine(*first, *self._args, **self._kwargs))
        context.register_event_handler(OnShutdown(on_shutdown=self._cancel))

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return self._task

    def _cancel(self, event: Event, context: LaunchContext) -> None:
        if self._task is not None:
            self._task.cancel()


class LogInfo(Action):
    """Logs a message as `[INFO] [launch.user]`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._msg = normalize_to_list_of_substitutions(msg)

    @property
    def msg(self) -> list[Substitution]:
        return self._msg

    def execute(self, context: LaunchContext) -> None:
        get_logger("launch.user").info(perform_substitutions(context, self._msg))


class Shutdown(EmitEvent):
    """Shuts the launch down: all processes are asked to end."""

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=events.Shutdown(reason=reason), **kwargs)

    def execute(self, context: LaunchContext) -> None:
        event = context.get_locals_as_dict().get("event")
        if isinstance(event, events.ProcessExited):
            get_logger("launch").info(f"process[{event.process_name}] was required: shutting down launched system")
        super().execute(context)
