"""The graph: who talks to whom, and why some do not."""

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
    """Lines of the graph, wrapped to the width."""

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
    """Nodes and topics as a drawing, what keeps two from being connected, and every node with what it offers."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("u", "all", "All", show=False)]

    def __init__(self, state: LiveState, id: str | None = None) -> None:
        super().__init__(id=id)
        self.state = state
        self.everything = False

    def compose(self) -> ComposeResult:
        yield GraphView(id="graph-view")
        yield ActionBar(id="graph-actions")

    def on_mount(self) -> None:
        self.show_list()

    def show_list(self) -> None:
        """The graph has changed, or the width."""
        view = self.query_one(GraphView)
        width = max(40, view.scrollable_content_region.width)
        graph = self.state.graph
        view.show_rows(rows_of_graph(graph, width, self.everything) if graph else [])
        word = "Without /rosout and the like" if self.everything else "All (/rosout and parameter services, too)"
        self.query_one(ActionBar).actions = (("u", word, "all"),)

    def on_resize(self, event: events.Resize) -> None:
        """Wrap again."""
        self.show_list()

    def action_all(self) -> None:
        """Show what every node has, too, or hide it."""
        self.everything = not self.everything
        self.show_list()
