"""Terminating a process."""

from __future__ import annotations

import logging
import signal
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .._entities import Action, BaseEventHandler, Event, SomeEntitiesType, Substitution
from ..events import ProcessTargetedEvent, SignalProcess, matches_action
from ..launch_context import LaunchContext
from ..substitutions._logic import PythonExpression
from ..utilities import perform_substitutions
from ._composition import OpaqueFunction
from ._events import EmitEvent, TimerAction

if TYPE_CHECKING:
    from ._process import ExecuteLocal


class OnTargeted(BaseEventHandler):
    """Handles events of one class that target one action's process."""

    def __init__(
        self,
        event_cls: type[ProcessTargetedEvent],
        action: ExecuteLocal,
        respond: Callable[[Any, LaunchContext], SomeEntitiesType | None],
    ) -> None:
        super().__init__(matcher=lambda event: isinstance(event, event_cls) and event.process_matcher(action))
        self._respond = respond

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self._respond(event, context)


class Escalation:
    """Escalates from SIGINT to SIGTERM to SIGKILL, after timeouts, for a process that does not end."""

    def __init__(
        self,
        action: ExecuteLocal,
        logger: logging.Logger,
        sigterm_timeout: list[Substitution],
        sigkill_timeout: list[Substitution],
    ) -> None:
        self._action = action
        self._logger = logger
        both_timeouts = PythonExpression(["float(", *sigterm_timeout, ") + float(", *sigkill_timeout, ")"])
        self._timers = [
            self._timer(sigterm_timeout, signal.SIGINT, signal.SIGTERM),
            self._timer([both_timeouts], signal.SIGTERM, signal.SIGKILL),
        ]

    def actions(self, *, send_sigint: bool) -> list[Action]:
        """Return the actions that start the escalation."""
        return [*self._timers, *([self._send(signal.SIGINT)] if send_sigint else [])]

    def cancel(self) -> None:
        """Stop the escalation, as the process has ended."""
        for timer in self._timers:
            timer.cancel()

    def _send(self, number: signal.Signals) -> EmitEvent:
        event = SignalProcess(signal_number=number, process_matcher=matches_action(self._action))
        return EmitEvent(event=event)

    def _timer(self, period: list[Substitution], ignored: signal.Signals, next_signal: signal.Signals) -> TimerAction:
        def report(context: LaunchContext) -> None:
            details = self._action.process_details or {}
            seconds = perform_substitutions(context, period)
            self._logger.error(
                f"process[{details.get('name')}] failed to terminate '{seconds}' seconds after receiving "
                f"'{ignored.name}', escalating to '{next_signal.name}'"
            )

        actions = [OpaqueFunction(function=report), self._send(next_signal)]
        return TimerAction(period=period, actions=actions, cancel_on_shutdown=False)


def signal_of(event: SignalProcess) -> signal.Signals:
    """Return the signal that an event requests by number or by name."""
    requested = event.signal
    return signal.Signals[requested] if isinstance(requested, str) else requested
