"""The base class of all dialogs: a small window over the screen."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.screen import ModalScreen


class Dialog[Answer](ModalScreen[Answer]):
    """Escape closes it, as does a click outside it; either way the answer is None."""

    CSS_PATH = Path(__file__).with_name("dialog.tcss")
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "close", "Close", key_display="Esc")]

    def action_close(self) -> None:
        """Close without an answer."""
        self.dismiss(None)

    def on_click(self, event: object) -> None:
        """Close on a click outside the window."""
        from textual.events import Click

        if isinstance(event, Click) and event.widget is self:
            self.dismiss(None)
