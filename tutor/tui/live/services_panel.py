"""The services: a list, a form to call one of them, and the answers."""

from __future__ import annotations

import itertools
import time
from typing import ClassVar

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import DataTable, Static

from tutor.live.protocol import Call, Cancel, Describe
from tutor.ros_model import Service
from tutor.tui.live import formatting
from tutor.tui.live.history import HistoryView, call_rows, waiting_row
from tutor.tui.live.request_form import ServiceForm
from tutor.tui.live.row_table import RowTable
from tutor.tui.live.state import LiveState
from tutor.tui.live.topics_panel import WatcherRequested
from tutor.tui.widgets.strip import Action, ActionBar

CALL_TIMEOUT_S = 30.0
"""How long to wait for the answer to a call, in seconds."""

_COLUMNS = ("Service", "Type", "Node")
_TICK_S = 0.1

_request_ids = itertools.count(1)


class ServicesPanel(Vertical):
    """Enter opens the form of the service under the cursor; Enter in the form calls it."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Back", show=False),
        Binding("u", "all", "All", show=False),
    ]

    def __init__(self, state: LiveState, id: str | None = None) -> None:
        super().__init__(id=id)
        self.state = state
        self.chosen: Service | None = None
        self.chosen_by_learner = False
        self.show_all = False
        self._listed: tuple[Service, ...] = ()

    def compose(self) -> ComposeResult:
        yield RowTable(id="services-table")
        yield Static(id="service-head")
        with Horizontal(id="service-body"):
            yield ServiceForm(id="service-form")
            yield HistoryView(id="service-history")
        yield ActionBar(id="service-actions")

    def on_mount(self) -> None:
        for name in _COLUMNS:
            self.table.add_column(name, key=name)
        self._ticker = self.set_interval(_TICK_S, self.show_history, pause=True)
        self.show_history()
        self._show_actions()

    @property
    def table(self) -> RowTable:
        """The list of services."""
        return self.query_one("#services-table", RowTable)

    async def choose_lesson_service(self) -> None:
        """Choose the first service of the lesson shown if it is there, unless the learner has chosen one."""
        if self.chosen_by_learner or self.state.graph is None:
            return
        for service in self.state.graph.services:
            if service.name in self.state.lesson_view.services[:1] and service != self.chosen:
                await self.choose(service, focus=False)

    # --- display ---

    def show_list(self) -> None:
        """Show the services in the current graph."""
        services = self.state.graph.services if self.state.graph else ()
        listed = tuple(service for service in services if self.show_all or not service.is_standard)
        if listed == self._listed:
            return
        self._listed = listed
        chosen = self.chosen.name if self.chosen else ""
        table = self.table
        table.clear()
        for service in listed:
            types = " and ".join(formatting.short_type(name) for name in service.types)
            table.add_row(Text(service.name), Text(types), Text(", ".join(service.nodes)), key=service.name)
        if chosen in table.rows:
            table.move_cursor(row=table.get_row_index(chosen))
        self._show_actions()

    async def show_form(self) -> None:
        """Show the form of the chosen service, if it has arrived."""
        if self.chosen is None or (form := self.state.forms.get(self.chosen.types[0])) is None:
            return
        shown = self.query_one(ServiceForm)
        if shown.form is not form:
            await shown.show(form)
            if self.screen.focused is self.table and self.has_class("-asked"):
                shown.focus_first()
        self.remove_class("-asked")
        self._show_actions()

    def show_history(self) -> None:
        """Show the calls and answers so far, with the time elapsed for pending calls."""
        now = time.time()
        rows = [waiting_row(service, since, now) for service, since in self.state.waiting.values()]
        rows += [row for outcome in self.state.calls for row in call_rows(outcome)]
        nothing = (((" The answers are listed here, with their times.", "quiet"),),)
        self.query_one("#service-history", HistoryView).show_outcomes(rows or nothing)
        if self.state.waiting:
            self._ticker.resume()
        else:
            self._ticker.pause()
            self._show_actions()

    def _show_actions(self) -> None:
        actions: list[Action] = []
        if self.state.waiting:
            actions.append(("Esc", "Cancel the call", "leave"))
        if self.chosen is not None and self.query_one(ServiceForm).form is not None:
            actions.append(("Enter", "Call", "call"))
        elif self._listed:
            actions.append(("Enter", "Choose", "choose"))
        actions.append(("u", "Fewer" if self.show_all else "All (including parameter services)", "all"))
        bar = self.query_one("#service-actions", ActionBar)
        bar.actions = tuple(actions)
        head = self.query_one("#service-head", Static)
        if self.chosen is None:
            nothing = "These nodes offer only the services that every node has."
            head.update("Choose a service and press Enter: its form opens here." if self._listed else nothing)
        else:
            types = " and ".join(formatting.short_type(name) for name in self.chosen.types)
            head.update(Content.assemble((self.chosen.name, "bold"), (f"  {types}", "$quiet")))

    # --- actions ---

    @on(DataTable.RowSelected, "#services-table")
    async def action_choose(self) -> None:
        """Open the form of the service under the cursor."""
        row = self.table.cursor_row
        if 0 <= row < len(self._listed):
            self.chosen_by_learner = True
            await self.choose(self._listed[row])

    async def choose(self, service: Service, focus: bool = True) -> None:
        """Open the form of a service, and focus it if `focus`."""
        already_open = self.chosen == service and self.query_one(ServiceForm).form is not None
        self.chosen = service
        if service.name in self.table.rows:
            self.table.move_cursor(row=self.table.get_row_index(service.name))
        if already_open:
            self.query_one(ServiceForm).focus_first()
            return
        await self.query_one(ServiceForm).clear()
        self.set_class(focus, "-asked")
        self._show_actions()
        if service.types[0] in self.state.forms:
            await self.show_form()
        else:
            self.post_message(WatcherRequested(Describe(service.types[0])))

    @on(ServiceForm.Sent)
    def action_call(self) -> None:
        """Call the service with what was typed."""
        form = self.query_one(ServiceForm)
        if self.chosen is None or form.form is None or form.form.problem:
            return
        if (request := form.values()) is None:
            return
        id = next(_request_ids)
        self.state.waiting[id] = (self.chosen.name, time.time())
        self.post_message(WatcherRequested(Call(id, self.chosen.name, self.chosen.types[0], request, CALL_TIMEOUT_S)))
        self.show_history()
        self._show_actions()

    def action_leave(self) -> None:
        """Cancel the latest pending call; if there is none, go back to the list."""
        if self.state.waiting:
            self.post_message(WatcherRequested(Cancel(next(reversed(self.state.waiting)))))
        else:
            self.table.focus()

    def action_all(self) -> None:
        """Show or hide the services that every node has."""
        self.show_all = not self.show_all
        self.show_list()
        self._show_actions()
