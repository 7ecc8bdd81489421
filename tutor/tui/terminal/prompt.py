"""The input line of the terminal page."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widgets import Input

from tutor.tui.terminal.history import History


class Prompt(Input, inherit_bindings=False):
    """An input with the keys of a shell.

    All keys are handled in `_on_key`, like the printable ones, and so in the order in which they were pressed: the
    action of a binding could overtake letters that are still queued.
    """

    # For the footer and for clicks on it; the keys themselves reach `_on_key` first.
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("tab", "complete", "Complete", key_display="Tab"),
        Binding("up", "older", "History", key_display="↑"),
        Binding("escape", "leave", "Leave", key_display="Esc"),
    ]

    class Interrupted(Message):
        """Ctrl+C was pressed."""

    class Completed(Message):
        """Tab was pressed."""

    class Cleared(Message):
        """Ctrl+L was pressed."""

    class Left(Message):
        """Esc was pressed."""

    class Turned(Message):
        """Request to show the previous (-1) or next (1) command's output."""

        def __init__(self, by: int) -> None:
            super().__init__()
            self.by = by

    def __init__(self, history: History, id: str | None = None) -> None:
        super().__init__(id=id, compact=True, placeholder="a command, such as: ros2 topic list", select_on_focus=False)
        self.history = history
        self._keys: Mapping[str, Callable[[], object]] = {
            "enter": self.action_submit,
            "up": self.action_older,
            "down": lambda: self._recall(self.history.newer(self.value)),
            "left": self.action_cursor_left,
            "right": self.action_cursor_right,
            "ctrl+left": self.action_cursor_left_word,
            "ctrl+right": self.action_cursor_right_word,
            "home": self.action_home,
            "ctrl+a": self.action_home,
            "end": self.action_end,
            "ctrl+e": self.action_end,
            "backspace": self.action_delete_left,
            "ctrl+h": self.action_delete_left,
            "delete": self.action_delete_right,
            "ctrl+d": self.action_delete_right,
            "ctrl+w": self.action_delete_left_word,
            "ctrl+u": self.action_delete_left_all,
            "ctrl+k": self.action_delete_right_all,
            "ctrl+v": self.action_paste,
            "tab": self.action_complete,
            "ctrl+c": lambda: self.post_message(self.Interrupted()),
            "ctrl+l": lambda: self.post_message(self.Cleared()),
            "escape": self.action_leave,
            "ctrl+pageup": lambda: self.post_message(self.Turned(-1)),
            "ctrl+pagedown": lambda: self.post_message(self.Turned(1)),
        }

    async def _on_key(self, event: events.Key) -> None:
        action = self._keys.get(event.key)
        if action is None:
            await super()._on_key(event)
            return
        event.stop()
        event.prevent_default()
        result = action()
        if isinstance(result, Awaitable) and event.key == "enter":
            await result

    def action_complete(self) -> None:
        """Ask for completion of the word before the cursor."""
        self.post_message(self.Completed())

    def action_older(self) -> None:
        """Recall the previous command."""
        self._recall(self.history.older(self.value))

    def action_leave(self) -> None:
        """Leave the prompt, so that the app's keys work again."""
        self.post_message(self.Left())

    def _recall(self, text: str) -> None:
        self.value = text
        self.cursor_position = len(text)
