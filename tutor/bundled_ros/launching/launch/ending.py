"""Terminating a process."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any

from tutor.bundled_ros.launching.launch.base import (
    BaseEventHandler,
    Event,
    LaunchContext,
    SomeEntitiesType,
    Substitution,
)
from tutor.bundled_ros.launching.launch.entities import Action
from tutor.bundled_ros.launching.launch.events import ProcessTargetedEvent, SignalProcess, matches_action
from tutor.bundled_ros.launching.launch.flow import EmitEvent, OpaqueFunction, TimerAction
from tutor.bundled_ros.launching.launch.logic import PythonExpression
from tutor.bundled_ros.launching.launch.logs import get_logger
from tutor.bundled_ros.launching.launch.values import perform_substitutions


class OnTargeted(BaseEventHandler):
    """Handles events of one class that target one action's process."""

    def __init__(
        self,
        event_cls: type[ProcessTargetedEvent],
        action: Action,
        respond: Callable[[Any, LaunchContext], SomeEntitiesType | None],
    ) -> None:
        super().__init__(matcher=lambda event: isinstance(event, event_cls) and event.process_matcher(action))
        self._respond = respond

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self._respond(event, context)


class Escalation:
    """Escalates from SIGINT to SIGTERM to SIGKILL, after timeouts, if the action's process does not end."""

    def __init__(
        self,
        action: Action,
        name: str,
        sigterm_timeout: list[Substitution],
        sigkill_timeout: list[Substitution],
    ) -> None:
        self._action = action
        self._name = name
        self._logger = get_logger(name)
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
            seconds = perform_substitutions(context, period)
            self._logger.error(
                f"process[{self._name}] failed to terminate '{seconds}' seconds after receiving "
                f"'{ignored.name}', escalating to '{next_signal.name}'"
            )

        actions = [OpaqueFunction(function=report), self._send(next_signal)]
        return TimerAction(period=period, actions=actions, cancel_on_shutdown=False)


def signal_of(event: SignalProcess) -> signal.Signals:
    """Return the signal that an event requests by number or by name."""
    requested = event.signal
    return signal.Signals[requested] if isinstance(requested, str) else requested
