"""The part of the code pane that shows code, and scrolls it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.message import Message
from textual.widget import Widget

from tutor.tui.commands import CANCEL, CHECK, EDIT, RESTART, RUN, STOP, key_label

_COMMAND_CHARACTERS = f"{EDIT.keys[0]}?1234567"
"""What is a command at once: to edit, help, and the pages."""


class CodeBody(Container, can_focus=True):
    """Container of the editors. It has the focus until typing starts: arrows scroll, Enter starts typing.

    While it is `guarded`, letters are no commands yet, for who sees their code may well begin to type: the first one
    posts `Typed`.
    """

    @dataclass
    class Typed(Message):
        """A text was typed, or pasted, though editing has not begun."""

        text: str

    class GuardChanged(Message):
        """Letters have become commands, or no longer are."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "screen.do('edit')", "Edit", show=False),
        Binding("up", "scroll_lines(-1)", show=False),
        Binding("down", "scroll_lines(1)", show=False),
        Binding("pageup", "scroll_pages(-1)", show=False),
        Binding("pagedown", "scroll_pages(1)", show=False),
        Binding("home", "scroll_edge(False)", show=False),
        Binding("end", "scroll_edge(True)", show=False),
        Binding("escape", "release", "Commands", key_display="Esc"),
        *(
            Binding(key, f"do('{command.name}')", command.label, key_display=key_label(key))
            for command in (RUN, RESTART, STOP, CHECK, CANCEL)
            for key in command.keys
            if key.startswith("f")
        ),
    ]
    takes_first_key: ClassVar[bool] = True
    """A character typed here moves the focus: what is typed next has to wait for that (see `Typeahead`)."""

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self.guarded = False

    @property
    def _offers(self) -> bool:
        """Whether typing here offers to edit: not in the editor, whose keys and pastes bubble up to here."""
        return self.guarded and self._editor is not None and self.screen.focused is self

    def guard(self, on: bool) -> None:
        """Have letters offer to edit, or be commands."""
        if on != self.guarded:
            self.guarded = on
            self.post_message(self.GuardChanged())

    def check_consume_key(self, key: str, character: str | None) -> bool:
        """Return whether a key is none of the commands: the footer shows what is left."""
        if character is None or not character.isprintable():
            return False
        return self._offers and character not in _COMMAND_CHARACTERS

    def on_key(self, event: events.Key) -> None:
        """Offer to edit, if this looks like typing."""
        if self.check_consume_key(event.key, event.character):
            event.stop()
            event.prevent_default()
            self.post_message(self.Typed(event.character or ""))

    def on_paste(self, event: events.Paste) -> None:
        """Offer to edit: a paste is no command either."""
        if self.has_focus and self._editor is not None:
            event.stop()
            self.post_message(self.Typed(event.text))

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Bind the F keys here only while letters are no commands. Esc rather cancels a check that is running."""
        if action == "do":
            return self._offers and self.screen.check_action(action, parameters)
        if action == "release":
            return self._offers and not self.screen.check_action("do", (CANCEL.name,))
        return True

    async def action_do(self, name: str) -> None:
        """Run a command."""
        await self.run_action(f"screen.do('{name}')")

    def action_release(self) -> None:
        """Make letters commands."""
        self.guard(False)

    @property
    def _editor(self) -> Widget | None:
        return next((child for child in self.children if child.display), None)

    def action_scroll_lines(self, lines: int) -> None:
        """Scroll by this many lines, down if positive."""
        if self._editor is not None:
            self._editor.scroll_relative(y=lines, animate=False)

    def action_scroll_pages(self, pages: int) -> None:
        """Scroll by this many pages, down if positive."""
        self.action_scroll_lines(pages * max(1, self.size.height - 1))

    def action_scroll_edge(self, down: bool) -> None:
        """Scroll to the top or the bottom."""
        if self._editor is not None:
            (self._editor.scroll_end if down else self._editor.scroll_home)(animate=False)
