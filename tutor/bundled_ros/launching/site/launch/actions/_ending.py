"""How a process is brought to its end."""

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
    """An event of one class that asks something of one action's process."""

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
    """SIGTERM some time after SIGINT, and SIGKILL some time after that, for a process that does not end."""

    def __init__(
        self,
        action: ExecuteLocal,
        logger: logging.Logger,
        sigterm_timeout: list[Substitution],
        sigkill_timeout: list[Substitution],
    ) -> None:
        self._action = action
        self._logger = logger
        both = PythonExpression(["float(", *sigterm_timeout, ") + float(", *sigkill_timeout, ")"])
        self._timers = [
            self._timer(sigterm_timeout, signal.SIGINT, signal.SIGTERM),
            self._timer([both], signal.SIGTERM, signal.SIGKILL),
        ]

    def actions(self, *, send_sigint: bool) -> list[Action]:
        """What starts it."""
        return [*self._timers, *([self._send(signal.SIGINT)] if send_sigint else [])]

    def cancel(self) -> None:
        """The process has ended."""
        for timer in self._timers:
            timer.cancel()

    def _send(self, number: signal.Signals) -> EmitEvent:
        event = SignalProcess(signal_number=number, process_matcher=matches_action(self._action))
        return EmitEvent(event=event)

    def _timer(self, period: list[Substitution], failed: signal.Signals, next_one: signal.Signals) -> TimerAction:
        def report(context: LaunchContext) -> None:
            details = self._action.process_details or {}
            seconds = perform_substitutions(context, period)
            self._logger.error(
                f"process[{details.get('name')}] failed to terminate '{seconds}' seconds after receiving "
                f"'{failed.name}', escalating to '{next_one.name}'"
            )

        actions = [OpaqueFunction(function=report), self._send(next_one)]
        return TimerAction(period=period, actions=actions, cancel_on_shutdown=False)


def signal_of(event: SignalProcess) -> signal.Signals:
    """The signal that an event asks for, by number or by name."""
    asked = event.signal
    return signal.Signals[asked] if isinstance(asked, str) else asked
