"""The log page: what the nodes have logged, and the way from an error to its line."""

from __future__ import annotations

from tutor.session.node import Phase
from tutor.tui import commands, messages
from tutor.tui.control.host import HostScreen
from tutor.tui.control.nodes import Nodes
from tutor.tui.control.pages import Pages
from tutor.tui.widgets.editor import CodeEditor
from tutor.tui.widgets.log_pane import LogPane
from tutor.tui.widgets.status_bar import StatusBar


class Logs:
    """Shows what the nodes log, and which of them run. Its commands work while the log page is shown or focused.

    go_to_error works from any page.
    """

    def __init__(self, host: HostScreen, pane: LogPane, nodes: Nodes, pages: Pages) -> None:
        self._host, self._pane, self._nodes, self._pages = host, pane, nodes, pages
        self._phases: list[tuple[str, Phase]] = []

        def usable() -> bool:
            return pane.has_class("-filled") and (host.page == "log" or pane.has_focus_within)

        host.register(commands.LEVEL, pane.next_level, usable)
        host.register(commands.FILTER, pane.filter, usable)
        host.register(commands.PAUSE, pane.pause, usable)
        host.register(commands.CLEAR, pane.clear, usable)
        host.register(commands.GO_TO_ERROR, self.go_to_error, lambda: pane.has_class("-filled"))

    def go_to_error(self) -> None:
        """Put the cursor on the line of the learner's code that the last traceback names."""
        location = self._pane.error_location
        if location is None:
            self._host.say("No error in the log points into your code.")
        else:
            self._host.post_message(messages.GoToLine(*location))

    def node_changed(self, message: messages.NodeChanged) -> None:
        """Show a node's log, if it is the one shown, and all nodes' states, on the live page and in the bars, too."""
        host, nodes, domain = self._host, self._nodes, self._host.model.session.domain
        # Do not take the focus from a learner who is typing.
        if message.restarted and not isinstance(host.focused, CodeEditor):
            host.show_page("log")
        if message.path == nodes.shown:
            self._pane.show(message.state, domain, host.model.paths, nodes.stop_key(message.path))
        self._pages.arrange_side_by_side()
        self._pane.show_nodes({path: nodes.by_path[path].state for path in nodes.listed}, nodes.shown)
        states = [node.state for node in nodes.by_path.values()]
        host.query_one(StatusBar).show_nodes(states, domain)
        if (live := self._pages.live) is not None:
            live.set_own_nodes_running(bool(nodes.running))
        if (phases := [(state.file, state.phase) for state in states]) != self._phases:
            # Only on a new phase: refreshing recomposes the footer, which would flicker with each log line.
            self._phases = phases
            host.refresh_bindings()
