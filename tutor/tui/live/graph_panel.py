"""The graph panel: which nodes talk to each other, and why some do not."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical

from tutor.tui.live.graph_rows import rows_of_graph
from tutor.tui.live.state import LiveState
from tutor.tui.widgets.line_view import LineView
from tutor.tui.widgets.strip import ActionBar


class GraphView(LineView):
    """The rows of the graph, fitted to the width."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        f"line--{kind}" for kind in ("quiet", "title", "name", "bad", "warn", "node", "topic", "arrow")
    }
    DEFAULT_CSS = """
    GraphView {
        & > .line--quiet { color: $quiet; }
        & > .line--title { color: $primary; text-style: bold; }
        & > .line--name { text-style: bold; }
        & > .line--bad { color: $bad; }
        & > .line--warn { color: $warn; }
        & > .line--node { color: $foreground; }
        & > .line--topic { color: $code-type; }
        & > .line--arrow { color: $good; }
    }
    """


class GraphPanel(Vertical):
    """A drawing of nodes and topics, why endpoints are not connected, and what each node offers."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("u", "all", "All", show=False)]

    def __init__(self, state: LiveState, id: str | None = None) -> None:
        super().__init__(id=id)
        self.state = state
        self.show_all = False

    def compose(self) -> ComposeResult:
        yield GraphView(id="graph-view")
        yield ActionBar(id="graph-actions")

    def on_mount(self) -> None:
        self.show_list()

    def show_list(self) -> None:
        """Show the current graph at the current width."""
        view = self.query_one(GraphView)
        width = max(40, view.scrollable_content_region.width)
        graph = self.state.graph
        view.show_rows(rows_of_graph(graph, width, self.show_all) if graph else [])
        label = "Hide /rosout and the like" if self.show_all else "All (including /rosout and parameter services)"
        self.query_one(ActionBar).actions = (("u", label, "all"),)

    def on_resize(self, event: events.Resize) -> None:
        """Fit the graph to the new width."""
        self.show_list()

    def action_all(self) -> None:
        """Show or hide the topics and services that every node has."""
        self.show_all = not self.show_all
        self.show_list()
