"""Keeps typed input in order, however far the app lags behind."""

from __future__ import annotations

from collections import deque
from collections.abc import Awaitable, Callable
from typing import Any

from textual.app import App
from textual.events import Key, Paste
from textual.message_pump import MessagePump
from textual.screen import Screen

Typed = Key | Paste

ROUNDS = 2
"""How often the marker follows a key: the second round queues up behind the messages that the key's action posted."""


class Typeahead:
    """Holds input back until the key before it has had its effect.

    Textual forwards a key to the focused widget. A letter is typed right there; a key with a binding (End, Esc, any
    command) first bubbles up through the message queue of each container to the app, which runs the action. Input that
    arrives meanwhile could overtake it, or end up in a widget that is about to lose the focus. So after each such key a
    marker (a callback) is sent through the same queues, and the next input is forwarded once the marker has arrived.
    """

    def __init__(self, app: App[Any], forward: Callable[[Typed], Awaitable[None]]) -> None:
        self._app, self._forward = app, forward
        self._queue: deque[Typed] = deque()
        self._blocked = False

    async def take(self, typed: Typed) -> None:
        """Forward this input now, or when its turn comes. To be called by the app, in its own task."""
        self._queue.append(typed)
        if not self._blocked:
            await self._drain()

    async def _drain(self) -> None:
        self._blocked = False
        while self._queue and not self._blocked:
            typed = self._queue.popleft()
            screen, focused = self._app.screen, self._app.focused
            if isinstance(typed, Key):
                # A letter in a text field is handled in the field's own queue: nothing can overtake it.
                in_field = focused is not None and focused.check_consume_key(typed.key, typed.character)
                self._blocked = not in_field or getattr(focused, "takes_first_key", False)
            await self._forward(typed)
            if self._blocked:
                start = focused or screen
                self._send_marker(start, start, screen, ROUNDS)

    def _send_marker(self, at: MessagePump | None, start: MessagePump, screen: Screen[Any], rounds: int) -> None:
        """Pass the marker up from `at`, queue by queue; widgets being removed take no messages and are skipped."""
        while at is not None and at is not self._app:
            parent = at._parent
            if at.call_later(self._send_marker, parent, start, screen, rounds):
                return
            at = parent
        self._app.call_later(self._marker_arrived, start, screen, rounds)

    async def _marker_arrived(self, start: MessagePump, screen: Screen[Any], rounds: int) -> None:
        if rounds > 1:
            self._send_marker(start, start, screen, rounds - 1)
        elif (top := self._app.screen) is not screen:  # a new screen has no focus until it is mounted: wait for that
            self._send_marker(top, top, top, ROUNDS)
        else:
            await self._drain()
