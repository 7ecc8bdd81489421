"""The screen that the controllers act on."""

from __future__ import annotations

import inspect
from collections.abc import Awaitable, Callable, Coroutine
from dataclasses import dataclass
from functools import partial
from typing import Any

from textual.reactive import Reactive
from textual.screen import Screen
from textual.widget import Widget

from tutor.content import Lesson
from tutor.tui import messages
from tutor.tui.commands import BY_NAME, Command
from tutor.tui.model import AppModel


def always() -> bool:
    """For what makes sense at any time."""
    return True


@dataclass(frozen=True, slots=True)
class CommandHandler:
    """What a command does, and whether it makes sense now."""

    run: Callable[[], Awaitable[object] | object]
    possible: Callable[[], bool] = always


class HostScreen(Screen[None]):
    """A screen with the app's model, and pages to turn to."""

    model: AppModel
    focused = Reactive[Widget | None](None, repaint=False)
    """Painted by the widgets that lose and get the focus. Textual's own repaints the whole screen."""

    def __init__(self) -> None:
        super().__init__()
        self._handlers: dict[Command, CommandHandler] = {}

    @property
    def page(self) -> str:
        """The page that is shown."""
        raise NotImplementedError

    @property
    def chosen_criterion(self) -> str:
        """The id of the criterion whose diagnosis is shown; empty where none is."""
        raise NotImplementedError

    def show_page(self, name: str) -> None:
        """Turn to a page, and focus what is on it."""
        raise NotImplementedError

    async def go_to(self, lesson: Lesson, page: str = "lesson") -> None:
        """Show a lesson."""
        raise NotImplementedError

    async def go_to_line(self, lesson: Lesson, line: int) -> None:
        """Show a line of a lesson's text, counted from 0."""
        raise NotImplementedError

    def preferences_changed(self) -> None:
        """What is remembered has changed: show what of it is to be seen."""
        raise NotImplementedError

    # --- commands ---

    def register(
        self, command: Command, run: Callable[[], Awaitable[object] | object], possible: Callable[[], bool] = always
    ) -> None:
        """`run` is what this command does; `possible`: whether it makes sense now."""
        self._handlers[command] = CommandHandler(run, possible)

    def can(self, command: Command) -> bool:
        """Whether a command makes sense now."""
        return self.is_mounted and self._handlers[command].possible()

    def do(self, command: Command) -> None:
        """Do what a command says."""
        result = self._handlers[command].run()
        if inspect.iscoroutine(result):
            self.run_worker(result, group="command")

    def action_do(self, name: str) -> None:
        """Do what the command of this name says."""
        self.do(BY_NAME[name])

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Hide what makes no sense now: one key is Run or Stop, Check or Cancel."""
        return self.can(BY_NAME[str(parameters[0])]) if action == "do" else True

    # --- work, and what is said ---

    def work(
        self, work: Callable[..., Coroutine[Any, Any, object]], *given: Any, group: str, exclusive: bool = False
    ) -> None:
        """Do this beside the screen."""
        # Given a coroutine, run_worker leaves it behind, never awaited, where the screen closes before it begins.
        begun: Callable[[], Any] = partial(work, *given)
        self.run_worker(begun, group=group, exclusive=exclusive)

    def show_error(self, text: str) -> None:
        """Tell that something could not be done."""
        self.post_message(messages.ErrorOccurred(text))

    def say(self, text: str, *, warn: bool = False) -> None:
        """Tell in passing."""
        self.notify(text, severity="warning" if warn else "information", timeout=10 if warn else 5)

    def ask(self, title: str, text: str, yes: str, do: Callable[[], object]) -> None:
        """Ask, and do it where the answer is yes."""
        from tutor.tui.dialogs.confirm import ConfirmScreen

        def answered(answer: bool | None) -> None:
            if answer:
                do()

        self.app.push_screen(ConfirmScreen(title, text, yes), answered)
