"""The line below the code that takes what is typed before editing has begun, and offers to edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.content import Content
from textual.message import Message
from textual.widgets import Input, Static


class _Typed(Input):
    """What was typed; the same letter once more is the letter's command instead."""

    def __init__(self, id: str) -> None:
        super().__init__(id=id, select_on_focus=False)
        self.command_key = ""

    def on_key(self, event: events.Key) -> None:
        """Run the command of the letter that is here, on the same letter."""
        if self.command_key and event.character == self.value == self.command_key:
            event.stop()
            event.prevent_default()
            self.post_message(EditOffer.CommandWanted(self.command_key))


class EditOffer(Horizontal):
    """Enter edits the file and types the text there; Esc makes letters commands again."""

    @dataclass
    class Accepted(Message):
        """The learner wants to edit; `text` is what they have typed so far."""

        text: str

    @dataclass
    class CommandWanted(Message):
        """The learner wants the command of this key; that of none, if it is empty."""

        key: str = ""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "accept", "Edit", key_display="Enter"),
        Binding("escape", "refuse", "Commands", key_display="Esc"),
    ]
    DEFAULT_CSS = """
    EditOffer {
        height: 1;
        display: none;
        background: $panel;
        & > Static { width: auto; padding: 0 1; }
        & > #offer-question { color: $warn; text-style: bold; }
        & > Input {
            width: 1fr;
            height: 1;
            border: none;
            padding: 0 1;
            background: $background;
            &:focus { border: none; }
        }
    }
    """

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self._text = self._shown = ""
        """The text that the offer began with, which may be a paste of many lines, and what the field shows for it."""
        self._command = ""

    def compose(self) -> ComposeResult:
        yield Static("Edit your file?", id="offer-question")
        yield _Typed(id="offer-text")
        yield Static(id="offer-keys")

    @property
    def _field(self) -> _Typed:
        return self.query_one(_Typed)

    def begin(self, text: str, command: str) -> None:
        """Offer to edit, now that this was typed; `command` is what the key would do otherwise, if anything."""
        first, *more = text.split("\n", 1)
        self._text, self._shown = text, f"{first} …" if more else first
        self._field.command_key = text if command else ""
        self._field.value = self._shown
        self._field.cursor_position = len(self._shown)
        self._command = command
        self._show_keys()
        self.display = True
        self.screen.set_focus(self._field, scroll_visible=False)

    def end(self) -> None:
        """Take the offer back."""
        self.display = False

    @on(events.DescendantBlur)
    def _left(self) -> None:
        self.end()

    def _show_keys(self) -> None:
        command = self._command if self._field.value == self._shown else ""
        again = ("  ", (self._shown, "bold $accent"), f" again: {command}") if command else ()
        no = ": neither" if command else ": no"
        keys = (("Enter", "bold $accent"), ": type this there", *again, "  ", ("Esc", "bold $accent"), no)
        self.query_one("#offer-keys", Static).update(Content.assemble(*keys))

    @on(Input.Changed)
    def _typed(self, event: Input.Changed) -> None:
        event.stop()
        self._show_keys()

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.action_accept()

    def action_accept(self) -> None:
        """Edit, and type the text there."""
        value = self._field.value
        begins = value.startswith(self._shown)
        self.post_message(self.Accepted(self._text + value.removeprefix(self._shown) if begins else value))

    def action_refuse(self) -> None:
        """Take the offer back, and make letters commands again."""
        self.post_message(self.CommandWanted())
