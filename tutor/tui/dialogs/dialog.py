"""A small window over the screen: the base of every question and note."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.screen import ModalScreen


class Dialog[Answer](ModalScreen[Answer]):
    """Escape closes it, and so does a click beside it; either way the answer is None."""

    CSS_PATH = Path(__file__).with_name("dialog.tcss")
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "close", "Close", key_display="Esc")]

    def action_close(self) -> None:
        """Leave without an answer."""
        self.dismiss(None)

    def on_click(self, event: object) -> None:
        """A click beside the window closes it."""
        from textual.events import Click

        if isinstance(event, Click) and event.widget is self:
            self.dismiss(None)
