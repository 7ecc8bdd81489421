"""The screen as the controllers know it."""

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
    """Predicate of commands that are available at any time."""
    return True


@dataclass(frozen=True, slots=True)
class CommandHandler:
    """What a command does, and whether it is available now."""

    run: Callable[[], Awaitable[object] | object]
    available: Callable[[], bool] = always


class HostScreen(Screen[None]):
    """A screen with the app's model and several pages."""

    model: AppModel
    focused = Reactive[Widget | None](None, repaint=False)
    """Repainting is left to the widgets that lose and gain focus. Textual's own reactive repaints the whole screen."""

    def __init__(self) -> None:
        super().__init__()
        self._handlers: dict[Command, CommandHandler] = {}

    @property
    def page(self) -> str:
        """The name of the page shown."""
        raise NotImplementedError

    @property
    def chosen_criterion(self) -> str:
        """The id of the criterion whose diagnosis is shown, or ""."""
        raise NotImplementedError

    def show_page(self, name: str) -> None:
        """Show a page, and focus its content."""
        raise NotImplementedError

    async def go_to(self, lesson: Lesson, page: str = "lesson") -> None:
        """Go to a lesson, and show the given page of it."""
        raise NotImplementedError

    async def go_to_line(self, lesson: Lesson, line: int) -> None:
        """Go to a line (from 0) of a lesson's text."""
        raise NotImplementedError

    def preferences_changed(self) -> None:
        """Show changed preferences, as far as they are visible."""
        raise NotImplementedError

    # --- commands ---

    def register(
        self, command: Command, run: Callable[[], Awaitable[object] | object], available: Callable[[], bool] = always
    ) -> None:
        """Have a command call `run`, whenever `available()` is true."""
        self._handlers[command] = CommandHandler(run, available)

    def can(self, command: Command) -> bool:
        """Return whether a command is available now."""
        return self.is_mounted and self._handlers[command].available()

    def do(self, command: Command) -> None:
        """Run a command."""
        result = self._handlers[command].run()
        if inspect.iscoroutine(result):
            self.run_worker(result, group="command")

    def action_do(self, name: str) -> None:
        """Run the command of this name."""
        self.do(BY_NAME[name])

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Disable unavailable commands, as one key may be Run or Stop, Check or Cancel."""
        return self.can(BY_NAME[str(parameters[0])]) if action == "do" else True

    # --- workers, notes and questions ---

    def start_worker(
        self, work: Callable[..., Coroutine[Any, Any, object]], *args: Any, group: str, exclusive: bool = False
    ) -> None:
        """Run `work(*args)` in a worker of this screen."""
        # Not a coroutine: run_worker would never await it if the screen closed before the worker starts.
        bound: Callable[[], Any] = partial(work, *args)
        self.run_worker(bound, group=group, exclusive=exclusive)

    def show_error(self, text: str) -> None:
        """Report that something could not be done."""
        self.post_message(messages.ErrorOccurred(text))

    def say(self, text: str, *, warn: bool = False) -> None:
        """Show a toast."""
        self.notify(text, severity="warning" if warn else "information", timeout=10 if warn else 5)

    def ask(self, title: str, text: str, yes: str, do: Callable[[], object]) -> None:
        """Ask a yes-or-no question, and call `do` if the answer is yes."""
        from tutor.tui.dialogs.simple import ConfirmScreen

        def answered(answer: bool | None) -> None:
            if answer:
                do()

        self.app.push_screen(ConfirmScreen(title, text, yes), answered)
