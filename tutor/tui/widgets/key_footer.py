"""The keys at the foot of a screen."""

from __future__ import annotations

from typing import Any

from textual.screen import Screen
from textual.widgets import Footer


class KeyFooter(Footer):
    """A footer that is composed again only where another key, or another word, is to be read.

    Textual's own is whenever the focus moves, though most moves change none of it: two more layouts of the whole
    screen between a key and what it shows.
    """

    def __init__(self, *, compact: bool = False) -> None:
        super().__init__(show_command_palette=False, compact=compact)
        self._read: list[tuple[str, str, str, bool]] = []

    def bindings_changed(self, screen: Screen[Any]) -> None:
        """Compose it again where it would read otherwise."""
        if not screen.app.app_focus:
            return
        read = [
            (screen.app.get_key_display(binding), binding.description, binding.action, enabled)
            for _, binding, enabled, _ in screen.active_bindings.values()
            if binding.show
        ]
        if read != self._read:
            self._read = read
            super().bindings_changed(screen)
