"""Which page is shown, and where the panels are."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from textual.containers import Container
from textual.widgets import ContentSwitcher, Tabs

from tutor.tui import commands
from tutor.tui.control.host import HostScreen
from tutor.tui.control.layout import Criteria, Layout, layout_for
from tutor.tui.control.preferences import Preferences
from tutor.tui.live.launching import watcher_command
from tutor.tui.live.pane import LivePane
from tutor.tui.terminal.history import History
from tutor.tui.terminal.pane import TerminalPane
from tutor.tui.widgets.code_pane import CodePane
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.lesson_list import LessonList
from tutor.tui.widgets.lesson_view import LessonView
from tutor.tui.widgets.log_pane import LogPane

SIDE_BY_SIDE_FROM = 112
"""From this many columns on there is room for the log beside Live."""


class Pages:
    """Turns pages and folds panels. Criteria have a page of their own only where there is no room beside it."""

    def __init__(self, host: HostScreen, preferences: Preferences, node_runs: Callable[[], bool]) -> None:
        self._host, self._preferences, self._node_runs = host, preferences, node_runs
        self.current = "lesson"
        self.live: LivePane | None = None
        """The live page, if it has been opened."""
        self.terminal: TerminalPane | None = None
        """The terminal page, if it has been opened."""
        self._shape: Layout | None = None
        for name, command in commands.PAGES.items():
            host.register(command, partial(self.show, name))
        for name, command in commands.LIVE_TABS.items():
            host.register(command, partial(self.show_live, name))
        host.register(commands.PUBLISH, self.publish)
        host.register(commands.LESSONS, self.toggle_lessons)
        host.register(commands.ZOOM, self.zoom)
        host.register(commands.SIDE_BY_SIDE, self.switch_side_by_side)

    @property
    def folded(self) -> bool:
        """Whether the criteria are behind a tab."""
        return self._host.has_class("-folded")

    def show(self, name: str) -> None:
        """Turn to a page, and focus what is on it."""
        if name == "criteria" and not self.folded:
            self._host.remove_class("-zoomed")
            self._host.query_one(CriteriaPanel).open()
            return
        self._turn(name)
        self._host.query_one(Tabs).active = f"tab-{name}"
        self._focus(name)

    def show_live(self, tab: str) -> None:
        """Turn to the live page, and to one of its tabs."""
        self.show("live")
        self._open_live().open_tab(tab)

    def publish(self) -> None:
        """Turn to the live page, and publish a message from there."""
        self.show("live")
        live = self._open_live()
        live.call_after_refresh(live.publish)

    def tab_chosen(self, name: str) -> None:
        """A tab was activated, by us or by the learner."""
        if name == self.current:
            return
        self._turn(name)
        if not isinstance(self._host.focused, Tabs | LessonList):
            self._focus(name)

    def _turn(self, name: str) -> None:
        self.current = name
        self._host.set_class(name == "criteria", "-criteria")
        if name == "live":
            self._open_live()
        elif name == "terminal":
            self.open_terminal()
        self._host.query_one(CriteriaPanel).show_reading(name == "lesson")
        if name != "criteria":
            self._host.query_one(ContentSwitcher).current = name
        self.arrange_side_by_side()
        self._preferences.update(page=name)
        self._host.refresh_bindings()

    def _focus(self, name: str) -> None:
        if name == "code":
            self._host.query_one(CodePane).focus_content()
        elif name == "live":
            self._open_live().focus_content()
        elif name == "terminal":
            self.open_terminal().focus_content()
        else:
            target = {"log": "#log-view", "criteria": "#criteria-list"}.get(name, "#lesson")
            self._host.set_focus(self._host.query_one(target), scroll_visible=False)

    def _open_live(self) -> LivePane:
        """The live page, which watches from the first time on that it is opened."""
        if not (found := self.live):
            self.live = found = LivePane(id="live-pane")
            self._host.query_one("#live", Container).mount(found)
            found.show_for(self._host.model.lesson)
            found.nodes_run(self._node_runs())
            session = self._host.model.session
            found.call_after_refresh(found.start_watching, lambda: watcher_command(session.domain))
        return found

    def open_terminal(self) -> TerminalPane:
        """The terminal page, made the first time that it is asked for."""
        if not (found := self.terminal):
            session = self._host.model.session
            self.terminal = found = TerminalPane(session.shell, History(session.typed_commands()), id="terminal-pane")
            self._host.query_one("#terminal", Container).mount(found)
        return found

    # --- log and Live side by side ---

    def arrange_side_by_side(self) -> None:
        """Show the log beside Live, where there is something in both, and room; else the page alone."""
        host, log, live = self._host, self._host.query_one(LogPane), self._host.query_one("#live", Container)
        full = self.live is not None and log.has_class("-filled")
        wanted = host.model.state.side_by_side and full and host.size.width >= SIDE_BY_SIDE_FROM
        both = wanted and self.current in ("log", "live")
        if not both and not host.has_class("-split"):
            return
        host.set_class(both, "-split")
        for name, page in (("log", log), ("live", live)):
            page.display = both or self.current == name

    def switch_side_by_side(self) -> None:
        """Show the log beside Live from now on, or not."""
        on = not self._host.model.state.side_by_side
        self._preferences.update(side_by_side=on)
        self.arrange_side_by_side()
        room = self._host.size.width >= SIDE_BY_SIDE_FROM
        text = "Log and Live are shown side by side." if on else "Log and Live are shown one at a time."
        needs = "" if room or not on else f" That takes {SIDE_BY_SIDE_FROM} columns."
        self._host.say(text + needs)

    # --- the panels ---

    def arrange(self, width: int, height: int) -> None:
        """Lay the panels out for a size."""
        self.arrange_side_by_side()
        shape = layout_for(width, height)
        if shape == self._shape:
            return
        self._shape = shape
        host, state = self._host, self._host.model.state
        for place in Criteria:
            host.set_class(shape.criteria is place, f"-{place}", update=False)
        host.set_class(not shape.lessons, "-no-lessons", update=False)
        host.set_class(not state.lessons_shown, "-lessons-away", update=False)
        host.set_class(state.zoomed, "-zoomed", update=False)
        host.remove_class("-drawer", update=False)
        host.update_node_styles()  # once for all of them: it restyles the whole screen
        tabs = host.query_one(Tabs)
        if shape.criteria is Criteria.FOLDED:
            tabs.show("tab-criteria")
            return
        if self.current == "criteria":
            self._turn("lesson")
            tabs.active = "tab-lesson"
        tabs.hide("tab-criteria")

    def toggle_lessons(self) -> None:
        """Show or hide the list of lessons."""
        host, listed = self._host, self._host.query_one(LessonList)
        if host.has_class("-no-lessons") or host.has_class("-split"):
            host.toggle_class("-drawer")
            shown = host.has_class("-drawer")
        else:
            shown = host.has_class("-lessons-away") or host.has_class("-zoomed")
            host.remove_class("-zoomed")
            host.set_class(not shown, "-lessons-away")
            self._preferences.update(lessons_shown=shown, zoomed=False)
        if shown:
            host.set_focus(listed)
        elif host.focused in (listed, None):
            host.set_focus(host.query_one(LessonView))

    def zoom(self) -> None:
        """Give the page all the room, or show the panels again."""
        self._host.toggle_class("-zoomed")
        self._preferences.update(zoomed=self._host.has_class("-zoomed"))
