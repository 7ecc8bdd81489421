"""The parameters of all nodes: a table to set them in, and the outcome of every set."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import ClassVar

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.widgets import DataTable, Input, Static

from tutor.live.protocol import Refresh, SetParameter
from tutor.ros_model import Parameter
from tutor.ros_model.values import format_value, parse_parameter
from tutor.tui.live import formatting
from tutor.tui.live.history import HistoryView, set_rows
from tutor.tui.live.row_table import RowTable
from tutor.tui.live.state import LiveState
from tutor.tui.live.topics_panel import WatcherRequested
from tutor.tui.widgets.steady_static import SteadyStatic
from tutor.tui.widgets.strip import ActionBar

_COLUMNS = ("Node", "Parameter", "Value", "Type", "Allowed")
_MAX_VALUE_CHARS = 40
_EDITING_ACTIONS = (("Enter", "Set", "set"), ("Esc", "Cancel", "leave"))

_request_ids = itertools.count(1)


class ParametersPanel(Vertical):
    """Enter opens the value under the cursor; Enter again sets it, and the node's answer is listed below."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("R", "refresh", "Refresh", show=False),
        Binding("u", "all", "All", show=False),
        Binding("escape", "leave", "Cancel", show=False),
    ]

    def __init__(self, state: LiveState, id: str | None = None) -> None:
        super().__init__(id=id)
        self.state = state
        self.editing: Parameter | None = None
        self.show_all = False
        self._listed: tuple[Parameter, ...] = ()

    def compose(self) -> ComposeResult:
        yield RowTable(id="parameters-table")
        yield SteadyStatic(id="parameters-silent", markup=False)
        with Horizontal(id="parameter-edit"):
            yield Static(id="parameter-name", markup=False)
            yield Input(id="parameter-value", compact=True)
        yield Static(id="parameter-problem", markup=False)
        yield HistoryView(id="parameter-history")
        yield ActionBar(id="parameter-actions")

    def on_mount(self) -> None:
        for name in _COLUMNS:
            self.table.add_column(name, key=name)
        self.show_history()
        self._show_actions()

    @property
    def table(self) -> RowTable:
        """The table of parameters."""
        return self.query_one("#parameters-table", RowTable)

    # --- display ---

    def show_list(self) -> None:
        """Show the current parameters of all nodes."""
        listed = tuple(self.state.listed_parameters(self.show_all))
        table = self.table
        if [_key(parameter) for parameter in listed] != [_key(parameter) for parameter in self._listed]:
            selected = self._parameter_under_cursor()
            table.clear()
            for parameter in listed:
                table.add_row(*self._cells(parameter), key=_key(parameter))
            if selected is not None and _key(selected) in table.rows:
                table.move_cursor(row=table.get_row_index(_key(selected)))
        elif listed != self._listed:
            for parameter in listed:
                for name, cell in zip(_COLUMNS, self._cells(parameter), strict=True):
                    if table.get_cell(_key(parameter), name) != cell:
                        table.update_cell(_key(parameter), name, cell, update_width=True)
        self._listed = listed
        if self.editing is not None and _key(self.editing) not in table.rows:
            self.action_leave()
        text = "\n".join(self._notes())
        self.query_one("#parameters-silent", Static).update(text)
        self.set_class(bool(text), "-silent")

    def _notes(self) -> Iterator[str]:
        """Yield a line on nodes that are not listed, and one on nodes that do not answer."""
        shown = [node for node in sorted(self.state.parameters) if self.show_all or self.state.is_of_lesson(node)]
        if others := sorted({*self.state.parameters} - {*shown}):
            yield f"From another exercise: {', '.join(others)}. u lists their parameters, too."
        if silent := [node for node in shown if not self.state.parameters[node].answered]:
            yield f"! {', '.join(silent)} does not answer: does it spin? (Retried every few seconds.)"

    def show_history(self) -> None:
        """Show the outcomes so far."""
        rows = [row for outcome in self.state.sets for row in set_rows(outcome)]
        placeholder = (((" What you set, and how the node answers, is listed here.", "quiet"),),)
        self.query_one("#parameter-history", HistoryView).show_outcomes(rows or placeholder)

    def _show_actions(self) -> None:
        toggle = ("u", "Hide the standard ones" if self.show_all else "All (including use_sim_time)", "all")
        idle = (("Enter", "Set", "edit"), ("R", "Refresh", "refresh"), toggle)
        self.query_one("#parameter-actions", ActionBar).actions = idle if self.editing is None else _EDITING_ACTIONS

    def _cells(self, parameter: Parameter) -> tuple[Text, ...]:
        value = format_value(parameter.value) if parameter.value is not None else "(not set)"
        if len(value) > _MAX_VALUE_CHARS:
            value = f"{value[:_MAX_VALUE_CHARS]}..."
        return (
            Text(parameter.node),
            Text(parameter.name),
            Text(value),
            Text(parameter.type),
            Text(formatting.allowed(parameter)),
        )

    def _parameter_under_cursor(self) -> Parameter | None:
        row = self.table.cursor_row
        return self._listed[row] if 0 <= row < len(self._listed) else None

    # --- actions ---

    def action_refresh(self) -> None:
        self.post_message(WatcherRequested(Refresh()))

    def action_all(self) -> None:
        """Show or hide the parameters that every node has, and those of nodes from another exercise."""
        self.show_all = not self.show_all
        self.show_list()
        self._show_actions()

    @on(DataTable.RowSelected, "#parameters-table")
    def action_edit(self) -> None:
        """Open the value under the cursor."""
        if (selected := self._parameter_under_cursor()) is None:
            return
        if selected.read_only:
            self.notify(f"{selected.name} is read-only: it is set when the node starts.")
            return
        self.editing = selected
        self.query_one("#parameter-name", Static).update(f"Set {selected.node} {selected.name} ({selected.type})")
        field = self.query_one("#parameter-value", Input)
        field.value = format_value(selected.value)
        self.query_one("#parameter-problem", Static).update("")
        self.add_class("-editing")
        self._show_actions()
        field.focus()

    @on(Input.Submitted, "#parameter-value")
    def action_set(self) -> None:
        """Set the parameter to what was typed."""
        if self.editing is None:
            return
        try:
            kind, value = parse_parameter(self.editing, self.query_one("#parameter-value", Input).value)
        except ValueError as error:
            self.query_one("#parameter-problem", Static).update(f"✗ {error}")
            self.add_class("-problem")
            return
        request = SetParameter(next(_request_ids), self.editing.node, self.editing.name, kind, value)
        self.post_message(WatcherRequested(request))
        self.action_leave()

    @on(Input.Changed, "#parameter-value")
    def _typed(self) -> None:
        self.remove_class("-problem")

    def action_leave(self) -> None:
        """Stop editing, and go back to the table."""
        if self.editing is None:
            return
        self.editing = None
        self.remove_class("-editing", "-problem")
        self._show_actions()
        self.table.focus()


def _key(parameter: Parameter) -> str:
    return f"{parameter.node} {parameter.name}"
