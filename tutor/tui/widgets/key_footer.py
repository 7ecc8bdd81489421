"""The keys at the foot of a screen."""

from __future__ import annotations

from typing import Any

from textual.screen import Screen
from textual.widgets import Footer


class KeyFooter(Footer):
    """A footer that is recomposed only when the keys or words it shows have changed.

    Textual recomposes its own footer whenever the focus moves, though most moves leave the text as it is: two more
    layouts of the whole screen between a key press and its effect.
    """

    def __init__(self, *, compact: bool = False) -> None:
        super().__init__(show_command_palette=False, compact=compact)
        self._shown: list[tuple[str, str, str, bool]] = []

    def bindings_changed(self, screen: Screen[Any]) -> None:
        """Recompose the footer if its text would change."""
        if not screen.app.app_focus:
            return
        shown = [
            (screen.app.get_key_display(binding), binding.description, binding.action, enabled)
            for _, binding, enabled, _ in screen.active_bindings.values()
            if binding.show
        ]
        if shown != self._shown:
            self._shown = shown
            super().bindings_changed(screen)
