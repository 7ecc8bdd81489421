"""The screen that the controllers act on."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Coroutine
from dataclasses import dataclass
from functools import partial
from typing import Any

from textual.reactive import Reactive
from textual.screen import Screen
from textual.widget import Widget

from tutor.tui import messages
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

    def preferences_changed(self) -> None:
        """What is remembered has changed: show what of it is to be seen."""
        raise NotImplementedError

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
        from tutor.tui.screens.confirm import ConfirmScreen

        def answered(answer: bool | None) -> None:
            if answer:
                do()

        self.app.push_screen(ConfirmScreen(title, text, yes), answered)
