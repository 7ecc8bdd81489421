"""A dialog to publish a message: topic, type, field values, and once or at a rate."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, VerticalScroll
from textual.content import Content
from textual.widgets import Button, Input, Static

from tutor.live.protocol import Describe, Publish, WatcherRequest
from tutor.live.updates import RequestForm
from tutor.tui.dialogs.dialog import Dialog
from tutor.tui.live.request_form import ServiceForm

_TYPE = re.compile(r"(\w+)/(?:msg/)?([A-Z]\w*)")
_MAX_RATE_HZ = 1000.0


class PublishScreen(Dialog[Publish]):
    """Returns the message to publish. `type_of` gives the type of a known topic, else ""; `send` requests a form."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("f5", "publish", "Publish")]

    def __init__(self, topic: str, type_of: Callable[[str], str], send: Callable[[WatcherRequest], object]) -> None:
        super().__init__()
        self._topic, self._type_of, self._send = topic, type_of, send
        self._requested_type = ""

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="window", can_focus=False) as window:
            window.border_title = "Publish a message"
            window.border_subtitle = "Enter publishes · Tab moves on · Esc cancels"
            with Horizontal(classes="publish-line"):
                yield Static("Topic", classes="label")
                yield Input(self._topic, placeholder="as in /chatter", id="publish-topic", compact=True)
            with Horizontal(classes="publish-line"):
                yield Static("Type", classes="label")
                yield Input(placeholder="as in std_msgs/msg/String", id="publish-type", compact=True)
            yield ServiceForm(id="publish-fields")
            with Horizontal(classes="publish-line"):
                yield Static("Times per second", classes="label")
                yield Input(placeholder="empty: once", id="publish-rate", compact=True)
            yield Static(id="publish-typed", markup=False)
            with Horizontal(classes="dialog-buttons"):
                yield Button("Publish", id="publish")

    def on_mount(self) -> None:
        self.query_one("#publish-type", Input).value = self._type_of(self._topic)
        self.query_one("#publish-topic" if not self._topic else "#publish-type", Input).focus()

    @property
    def type_name(self) -> str:
        """The full name of the typed type; empty while there is none."""
        match = _TYPE.fullmatch(self.query_one("#publish-type", Input).value.strip())
        return f"{match[1]}/msg/{match[2]}" if match else ""

    async def show_form(self, form: RequestForm) -> None:
        """Show the fields of the typed type once they have arrived."""
        fields = self.query_one(ServiceForm)
        if form.type == self.type_name and fields.form != form:
            await fields.show(form)
            if not form.problem and isinstance(self.focused, Input) and self.focused.id == "publish-type":
                fields.focus_first()

    @on(Input.Changed, "#publish-topic")
    def _topic_typed(self, event: Input.Changed) -> None:
        if known := self._type_of(event.value.strip()):
            self.query_one("#publish-type", Input).value = known

    @on(Input.Changed, "#publish-type")
    async def _type_typed(self) -> None:
        name = self.type_name
        if name != self._requested_type:
            self._requested_type = name
            await self.query_one(ServiceForm).clear()
            if name:
                self._send(Describe(name))

    @on(Input.Submitted)
    @on(ServiceForm.Sent)
    @on(Button.Pressed, "#publish")
    def action_publish(self) -> None:
        """Publish what was typed if it is valid; otherwise say what is wrong."""
        topic = self.query_one("#publish-topic", Input).value.strip()
        form = self.query_one(ServiceForm)
        rate = self.query_one("#publish-rate", Input).value.strip()
        if not topic:
            self._show_problem("#publish-topic", "Name a topic, such as /chatter.")
        elif form.form is None or form.form.problem:
            self._show_problem("#publish-type", "Name a type that exists, such as std_msgs/msg/String.")
        elif (hz := _parse_rate(rate)) is None:
            self._show_problem("#publish-rate", f"Write a rate up to {_MAX_RATE_HZ:g}, such as 2, or nothing for once.")
        elif (values := form.values()) is not None:
            self.dismiss(Publish(topic if topic.startswith("/") else f"/{topic}", form.form.type, values, hz))

    def _show_problem(self, selector: str, text: str) -> None:
        self.query_one("#publish-typed", Static).update(Content.styled(f"✗ {text}", "$bad"))
        self.query_one(selector, Input).focus()


def _parse_rate(text: str) -> float | None:
    """Return messages per second, 0 for once; None if the text is not a rate."""
    if not text:
        return 0.0
    try:
        rate = float(text)
    except ValueError:
        return None
    return rate if 0 < rate <= _MAX_RATE_HZ else None
