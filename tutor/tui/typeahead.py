"""Keeps what is typed in order, however far the app is behind."""

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
"""This many times the way of a key is followed: the second time behind the messages that its action has posted."""


class Typeahead:
    """Holds back what is typed until the key before it has had its effect.

    Textual hands a key to the widget that has the focus. A letter is typed there and then; a key with a binding (End,
    Esc, any command) first passes through the queue of each container up to the app, which runs the action. What is
    typed meanwhile would overtake it, or be typed where the focus no longer is. So after each such key a callback
    follows it through the same queues, and the next one is handed on when that has arrived.
    """

    def __init__(self, app: App[Any], hand_on: Callable[[Typed], Awaitable[None]]) -> None:
        self._app, self._hand_on = app, hand_on
        self._waiting: deque[Typed] = deque()
        self._held = False

    async def take(self, typed: Typed) -> None:
        """Hand this on now, or when its turn comes. To be called by the app, in its own task."""
        self._waiting.append(typed)
        if not self._held:
            await self._go_on()

    async def _go_on(self) -> None:
        self._held = False
        while self._waiting and not self._held:
            typed = self._waiting.popleft()
            screen, focused = self._app.screen, self._app.focused
            if isinstance(typed, Key):
                # A letter in a text field is typed in the field's own turn: nothing can overtake it.
                self._held = focused is None or not focused.check_consume_key(typed.key, typed.character)
            await self._hand_on(typed)
            if self._held:
                start = focused or screen
                self._follow(start, start, screen, ROUNDS)

    def _follow(self, place: MessagePump | None, start: MessagePump, screen: Screen[Any], rounds: int) -> None:
        """Up from `place`, one queue after the other; a widget that is being removed takes no message any more."""
        while place is not None and place is not self._app:
            above = place._parent
            if place.call_later(self._follow, above, start, screen, rounds):
                return
            place = above
        self._app.call_later(self._arrive, start, screen, rounds)

    async def _arrive(self, start: MessagePump, screen: Screen[Any], rounds: int) -> None:
        if rounds > 1:
            self._follow(start, start, screen, rounds - 1)
        elif (top := self._app.screen) is not screen:  # which has no focus before it is mounted
            self._follow(top, top, top, ROUNDS)
        else:
            await self._go_on()
