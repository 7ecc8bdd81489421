"""A form for a service request or a message: one typed input per field, errors in plain words."""

from __future__ import annotations

from typing import Any

from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.content import Content
from textual.message import Message
from textual.widgets import Input, Static

from tutor.live.updates import RequestForm
from tutor.ros_model import Field
from tutor.ros_model.values import parse_value


class FieldRow(Vertical):
    """One field: its name and type, an input, and what is wrong with it."""

    def __init__(self, field: Field) -> None:
        super().__init__()
        self.field = field

    def compose(self) -> ComposeResult:
        with Horizontal():
            yield Static(Content.assemble(f"{self.field.path} ", (self.field.type, "$quiet")), classes="label")
            yield Input(self.field.default, compact=True)
        yield Static(classes="problem", markup=False)

    @property
    def input(self) -> Input:
        """The input for the value."""
        return self.query_one(Input)

    def read(self) -> Any:
        """Parse the value. If the text is invalid, show why and raise ValueError."""
        try:
            value = parse_value(self.field.type, self.input.value)
        except ValueError as error:
            self.query_one(".problem", Static).update(f"✗ {error}")
            self.add_class("-problem")
            raise
        self.remove_class("-problem")
        return value

    @on(Input.Changed)
    def _typed(self) -> None:
        self.remove_class("-problem")


class ServiceForm(VerticalScroll, can_focus=False):
    """The fields of one request or message, with their defaults."""

    class Sent(Message):
        """The learner has submitted the form."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.form: RequestForm | None = None

    async def show(self, form: RequestForm) -> None:
        """Show the fields of a form."""
        self.form = form
        await self.remove_children()
        if form.problem:
            await self.mount(Static(f"✗ {form.problem}", classes="problem", markup=False))
        elif not form.fields:
            await self.mount(Static("The request has no fields.", classes="quiet"))
        else:
            await self.mount(*(FieldRow(field) for field in form.fields))

    async def clear(self) -> None:
        """Show no form."""
        self.form = None
        await self.remove_children()

    def values(self) -> dict[str, Any] | None:
        """Return the typed values by field path; None, with the problems shown, if any is invalid."""
        values: dict[str, Any] = {}
        invalid: list[FieldRow] = []
        for row in self.query(FieldRow):
            try:
                values[row.field.path] = row.read()
            except ValueError:
                invalid.append(row)
        if invalid:
            invalid[0].input.focus()
            return None
        return values

    def focus_first(self) -> bool:
        """Focus the first input. Return whether there is one."""
        for row in self.query(FieldRow):
            row.input.focus()
            return True
        return False

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.post_message(self.Sent())
