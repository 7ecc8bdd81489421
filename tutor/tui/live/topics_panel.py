"""The topics: a list of all, and the messages on the chosen one."""

from __future__ import annotations

import time
from typing import ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import DataTable, Static
from textual.widgets.data_table import ColumnKey

from tutor.live.protocol import Clear, Follow, Plot, Unfollow, WatcherRequest
from tutor.ros_model import Topic
from tutor.tui.live import formatting
from tutor.tui.live.echo_view import EchoView
from tutor.tui.live.plot_view import PlotView
from tutor.tui.live.row_table import RowTable
from tutor.tui.live.state import LiveState, TopicView
from tutor.tui.live.topic_texts import cells, plot_head, topic_head
from tutor.tui.widgets.strip import Action, ActionBar

_COLUMNS = ("", "Topic", "Rate", "Count", "Pub", "Sub", "Type")
_LIST_REFRESH_S = 0.45
"""Updates of topics refresh the list at most this often: it costs more to paint than the chosen topic."""

_TICK_S = 1.0

_PUBLISH: Action = ("M", "Publish", "screen.do('publish')")
_OTHER_FIELD = ("y", "Field", "next_field")


class WatcherRequested(Message):
    """A panel has a request for the watcher process."""

    def __init__(self, command: WatcherRequest) -> None:
        super().__init__()
        self.command = command


class TopicsPanel(Vertical):
    """Enter follows the topic under the cursor; its messages are shown below as by `ros2 topic echo`, with a plot."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("space", "pause", "Pause", show=False),
        Binding("C", "clear", "Clear", show=False),
        Binding("y", "next_field", "Field", show=False),
        Binding("plus,equals_sign", "zoom(1)", "Longer", show=False),
        Binding("minus", "zoom(-1)", "Shorter", show=False),
        Binding("delete,backspace", "unfollow", "Unfollow", show=False),
    ]

    def __init__(self, state: LiveState, id: str | None = None) -> None:
        super().__init__(id=id)
        self.state = state
        self.chosen = ""
        self.chosen_by_learner = False
        self._listed: tuple[Topic, ...] = ()
        self._next_list_refresh = 0.0
        self._shown_at = 0.0
        """When the chosen topic was shown last; by the monotonic clock, as the above."""

    def compose(self) -> ComposeResult:
        yield RowTable(id="topics-table")
        yield Static(id="topic-head")
        with Horizontal(id="topic-body"):
            yield EchoView(id="topic-echo")
            with Vertical(id="topic-plot"):
                yield Static(id="plot-head")
                yield PlotView(id="plot")
        yield ActionBar(id="topic-actions")

    def on_mount(self) -> None:
        table = self.table
        for name in _COLUMNS:
            table.add_column(name, key=name or "mark")
        self.set_interval(_TICK_S, self._tick)

    def on_show(self, _event: events.Show) -> None:
        """Catch up with updates missed while hidden, one frame later, so that the page itself appears at once."""
        self.call_after_refresh(self._tick)

    @property
    def table(self) -> RowTable:
        """The list of topics."""
        return self.query_one("#topics-table", RowTable)

    @property
    def view(self) -> TopicView | None:
        """The chosen topic, if it is followed."""
        return self.state.topics.get(self.chosen)

    # --- display ---

    def show_list(self) -> None:
        """Show the current graph and the followed topics."""
        listed = tuple(self.state.listed_topics())
        table = self.table
        if [topic.name for topic in listed] != [topic.name for topic in self._listed]:
            chosen = self.chosen or (listed[0].name if listed else "")
            with self.prevent(DataTable.RowHighlighted):
                table.clear()
                for topic in listed:
                    table.add_row(*cells(self.state, topic), key=topic.name)
                names = [topic.name for topic in listed]
                if names:
                    table.move_cursor(row=names.index(chosen) if chosen in names else 0)
                    self.chosen = chosen if chosen in names else names[0]
        self._listed = listed
        self._update_rows()
        self.show_chosen()

    def show_update(self, name: str) -> None:
        """Show an update of a topic. If updates are frequent, the list is refreshed only now and then."""
        if not self.display:
            return
        if time.monotonic() >= self._next_list_refresh:
            self._update_rows()
        if name == self.chosen:
            self.show_chosen()

    def show_chosen(self) -> None:
        """Show the topic under the cursor."""
        view = self.view
        now = time.time()
        self._shown_at = time.monotonic()
        self.set_class(view is None or not view.fields, "-no-numbers")
        self.query_one("#topic-actions", ActionBar).actions = self._actions(view)
        self.query_one("#topic-head", Static).update(topic_head(self.state, self.chosen, view, now), layout=False)
        echo, plot = self.query_one(EchoView), self.query_one(PlotView)
        if view is None:
            echo.show_lines(self.chosen, (), 0)
            return
        points, snapshot = view.points, view.snapshot
        band = self.state.lesson_view.band_of(view.topic)
        if snapshot is not None:
            now = snapshot.at
            plot.show(snapshot.points, now, "paused", band)
            echo.show_lines(view.topic, snapshot.lines, snapshot.line_count)
        else:
            if points and view.update and formatting.is_silent(view.update, max(0.0, now - view.updated_at)):
                plot.show(tuple(points), points[-1][0], "the last one", band)
            else:
                plot.show(tuple(points), max(now, points[-1][0]) if points else now, band=band)
            echo.show_lines(view.topic, view.lines, view.line_count)
        self.query_one("#plot-head", Static).update(plot_head(view, band), layout=False)

    def _actions(self, view: TopicView | None) -> tuple[Action, ...]:
        if not self.chosen:
            return (_PUBLISH,)
        if view is None:
            return (("Enter", "Follow", "follow"), _PUBLISH)
        field_action = (_OTHER_FIELD,) if len(view.fields) > 1 else ()
        zoom: tuple[Action, ...] = (("+", "Longer", "zoom(1)"), ("-", "Shorter", "zoom(-1)")) if view.fields else ()
        return (
            ("Space", "Go on" if view.paused else "Pause", "pause"),
            ("C", "Clear", "clear"),
            *field_action,
            *zoom,
            ("Del", "Unfollow", "unfollow"),
            _PUBLISH,
        )

    def _update_row(self, topic: Topic) -> None:
        table = self.table
        if topic.name not in table.rows:
            return
        for name, cell in zip(_COLUMNS, cells(self.state, topic), strict=True):
            key = name or "mark"
            if table.get_cell(topic.name, key) != cell:
                # A change of width lays out the whole page again, so only if needed.
                wider = cell.cell_len > table.columns[ColumnKey(key)].content_width
                table.update_cell(topic.name, key, cell, update_width=wider)

    def _tick(self) -> None:
        """Show that topics are silent: that raises no updates. What an update has just shown is not painted again."""
        now = time.monotonic()
        if self.display and now >= self._next_list_refresh:
            self._update_rows()
        if self.display and self.view is not None and now >= self._shown_at + _TICK_S / 2:
            self.show_chosen()

    def _update_rows(self) -> None:
        self._next_list_refresh = time.monotonic() + _LIST_REFRESH_S
        for topic in self._listed:
            self._update_row(topic)

    # --- actions ---

    def follow(self, topic: str, *, show: bool = True) -> None:
        """Follow a topic, now or when it appears; choose it if `show`."""
        if topic not in self.state.topics:
            self.state.topics[topic] = TopicView(topic)
            self.post_message(WatcherRequested(Follow(topic)))
        if not show:
            self.show_list()
            return
        self.chosen = topic
        self.show_list()
        if topic in self.table.rows:
            self.table.move_cursor(row=self.table.get_row_index(topic))

    def unfollow(self, topic: str) -> None:
        """Stop following a topic."""
        if self.state.topics.pop(topic, None) is not None:
            self.post_message(WatcherRequested(Unfollow(topic)))
            self.show_list()

    @on(DataTable.RowHighlighted, "#topics-table")
    def _highlighted(self, event: DataTable.RowHighlighted) -> None:
        if event.row_key.value:
            self.chosen_by_learner = self.chosen_by_learner or event.row_key.value != self.chosen
            self.chosen = event.row_key.value
            self.show_chosen()

    @on(DataTable.RowSelected, "#topics-table")
    def _selected(self, event: DataTable.RowSelected) -> None:
        if event.row_key.value:
            self.chosen_by_learner = True
            self.follow(event.row_key.value)

    def action_follow(self) -> None:
        if self.chosen:
            self.chosen_by_learner = True
            self.follow(self.chosen)

    def action_unfollow(self) -> None:
        self.unfollow(self.chosen)

    def action_pause(self) -> None:
        if self.view is not None:
            self.view.pause(time.time())
            self.show_chosen()

    def action_clear(self) -> None:
        if self.view is not None:
            self.view.clear()
            self.post_message(WatcherRequested(Clear(self.chosen)))
            self._update_rows()
            self.show_chosen()

    def action_next_field(self) -> None:
        view = self.view
        if view is None or len(view.fields) < 2:
            return
        index = view.fields.index(view.path) if view.path in view.fields else -1
        view.plot(view.fields[(index + 1) % len(view.fields)])
        self.post_message(WatcherRequested(Plot(self.chosen, view.path)))
        self.show_chosen()

    def action_zoom(self, by: int) -> None:
        self.query_one(PlotView).zoom(by)
