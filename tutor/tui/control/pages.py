"""Switches pages, arranges the panels for the size of the terminal, and runs a lesson's commands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING

from textual.containers import Container
from textual.widgets import ContentSwitcher, Tabs

from tutor.tui import commands
from tutor.tui.control.host import HostScreen
from tutor.tui.control.preferences import Preferences
from tutor.tui.lesson_commands import commands_in
from tutor.tui.widgets.code_pane import CodePane
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.lesson_list import LessonList
from tutor.tui.widgets.lesson_view import LessonView
from tutor.tui.widgets.log_pane import LogPane

if TYPE_CHECKING:
    from tutor.tui.live.pane import LivePane
    from tutor.tui.terminal.pane import TerminalPane

SIDE_BY_SIDE_MIN_WIDTH = 112
"""Minimum screen width, in columns, for showing the log beside Live."""


class Criteria(StrEnum):
    """Where the criteria go: behind a tab, below the text, or beside it."""

    FOLDED = "folded"
    STACKED = "stacked"
    BESIDE = "beside"


@dataclass(frozen=True, slots=True)
class Layout:
    """`lessons`: whether the lesson list has a column of its own; else it is a drawer over the text.

    `columns`: a page of the criteria has their diagnosis beside the list, for lack of height.
    """

    lessons: bool
    criteria: Criteria
    columns: bool = False


def layout_for(width: int, height: int) -> Layout:
    """Return the layout for a terminal of `width` columns and `height` rows."""
    if width >= 160:
        return Layout(True, Criteria.BESIDE)
    if width >= 90 and height >= 30:
        return Layout(width >= 100, Criteria.STACKED)
    return Layout(width >= 100, Criteria.FOLDED, columns=width >= 76 and height < 36)


class Pages:
    """Switches pages and folds panels. The criteria have a page of their own only if there is no room beside it."""

    def __init__(self, host: HostScreen, preferences: Preferences, node_is_running: Callable[[], bool]) -> None:
        self._host, self._preferences, self._node_is_running = host, preferences, node_is_running
        self.current = "lesson"
        self.live: LivePane | None = None
        """The live page, once it has been opened."""
        self.terminal: TerminalPane | None = None
        """The terminal page, once it has been opened."""
        self._layout: Layout | None = None
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
        """Whether the criteria are behind a tab, for lack of room."""
        return self._host.has_class("-folded")

    def show(self, name: str) -> None:
        """Show a page, and focus its content."""
        if name == "criteria" and not self.folded:
            self._host.remove_class("-zoomed")
            self.arrange_side_by_side()
            self._host.query_one(CriteriaPanel).open()
            return
        self._switch_to(name)
        self._host.query_one(Tabs).active = f"tab-{name}"
        self._focus(name)

    def show_live(self, tab: str) -> None:
        """Show the live page, with one of its tabs."""
        self.show("live")
        self._open_live().open_tab(tab)

    def publish(self) -> None:
        """Show the live page, and publish a message from there."""
        self.show("live")
        live = self._open_live()
        live.call_after_refresh(live.publish)

    def tab_chosen(self, name: str) -> None:
        """Handle an activated tab, be it by the app or by the learner."""
        if name == self.current:
            return
        self._switch_to(name)
        if not isinstance(self._host.focused, Tabs | LessonList):
            self._focus(name)

    def _switch_to(self, name: str) -> None:
        self.current = name
        self._host.set_class(name == "criteria", "-criteria")
        self._host.remove_class("-report")
        if name == "live":
            self._open_live()
        elif name == "terminal":
            self.open_terminal()
        self._host.query_one(CriteriaPanel).set_reading(name == "lesson")
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
        """Return the live page; the first call creates it and starts its watcher."""
        if not (pane := self.live):
            from tutor.tui.live.pane import LivePane  # late: the start does not wait for it
            from tutor.tui.live.watcher import watcher_command

            self.live = pane = LivePane(id="live-pane")
            self._host.query_one("#live", Container).mount(pane)
            pane.set_lesson(self._host.model.lesson)
            pane.set_own_nodes_running(self._node_is_running())
            session = self._host.model.session
            root = session.workspace.root
            pane.call_after_refresh(pane.start_watching, lambda: watcher_command(session.domain, workspace=root))
        return pane

    def restart_live(self) -> None:
        """Have the live page, if it is open, watch with the message types that are built now."""
        if self.live:
            self.live.restart_watching()

    def open_terminal(self) -> TerminalPane:
        """Return the terminal page; the first call creates it."""
        if not (pane := self.terminal):
            from tutor.tui.terminal.pane import TerminalPane  # late: the start does not wait for it

            session = self._host.model.session
            self.terminal = pane = TerminalPane(session.shell, id="terminal-pane")
            self._host.query_one("#terminal", Container).mount(pane)
        return pane

    # --- log and Live side by side ---

    def arrange_side_by_side(self) -> None:
        """Show the log beside Live if that is on, both have content, and there is room; else show one page."""
        host, log, live = self._host, self._host.query_one(LogPane), self._host.query_one("#live", Container)
        filled = self.live is not None and log.has_class("-filled")
        fits = host.size.width >= SIDE_BY_SIDE_MIN_WIDTH and not host.has_class("-zoomed")
        wanted = host.model.state.side_by_side and filled and fits
        both = wanted and self.current in ("log", "live")
        if not both and not host.has_class("-split"):
            return
        host.set_class(both, "-split")
        for name, page in (("log", log), ("live", live)):
            page.display = both or self.current == name

    def switch_side_by_side(self) -> None:
        """Toggle showing the log beside Live."""
        on = not self._host.model.state.side_by_side
        self._preferences.update(side_by_side=on)
        self.arrange_side_by_side()
        fits = self._host.size.width >= SIDE_BY_SIDE_MIN_WIDTH
        text = "Log and Live are shown side by side." if on else "Log and Live are shown one at a time."
        caveat = "" if fits or not on else f" That takes {SIDE_BY_SIDE_MIN_WIDTH} columns."
        self._host.say(text + caveat)

    # --- the panels ---

    def arrange(self, width: int, height: int) -> None:
        """Lay out the panels for a screen of this size."""
        self.arrange_side_by_side()
        if not self.choose_layout(width, height):
            return
        self._host.update_node_styles()  # once for all classes: it restyles the whole screen
        self.show_criteria_tab()

    def choose_layout(self, width: int, height: int) -> bool:
        """Set the screen's classes for this size, without restyling anything. Return whether the layout is another."""
        layout = layout_for(width, height)
        if layout == self._layout:
            return False
        self._layout = layout
        host, state = self._host, self._host.model.state
        for place in Criteria:
            host.set_class(layout.criteria is place, f"-{place}", update=False)
        host.set_class(layout.columns, "-columns", update=False)
        host.set_class(not layout.lessons, "-no-lessons", update=False)
        host.set_class(not state.lessons_shown, "-lessons-away", update=False)
        host.set_class(state.zoomed, "-zoomed", update=False)
        host.remove_class("-drawer", "-report", update=False)
        return True

    def show_criteria_tab(self) -> None:
        """Show the tab of the criteria if they are folded; else hide it, and leave their page."""
        tabs = self._host.query_one(Tabs)
        if self.folded:
            tabs.show("tab-criteria")
            return
        if self.current == "criteria":
            self._switch_to("lesson")
            tabs.active = "tab-lesson"
        tabs.hide("tab-criteria")

    def toggle_lessons(self) -> None:
        """Show or hide the list of lessons."""
        host, listed = self._host, self._host.query_one(LessonList)
        if host.has_class("-no-lessons") or host.has_class("-split"):
            host.toggle_class("-drawer")
            shown = host.has_class("-drawer")
        else:
            shown = any(map(host.has_class, ("-lessons-away", "-zoomed", "-report")))
            host.remove_class("-zoomed", "-report")
            host.set_class(not shown, "-lessons-away")
            self._preferences.update(lessons_shown=shown, zoomed=False)
        if shown:
            host.set_focus(listed)
        elif host.focused in (listed, None):
            host.set_focus(host.query_one(LessonView))

    def zoom(self) -> None:
        """Enlarge the part that has the focus, be it the page or the criteria; or show all panels again."""
        host = self._host
        around = host.focused.ancestors_with_self if host.focused is not None else []
        if host.has_class("-report"):
            host.remove_class("-report")
            return
        if host.query_one(CriteriaPanel) in around and not self.folded:
            host.add_class("-report")
            return
        host.toggle_class("-zoomed")
        self._preferences.update(zoomed=host.has_class("-zoomed"))
        if host.has_class("-split"):
            pages = {name: host.query_one(f"#{name}") for name in ("log", "live")}
            self._switch_to(next((name for name, page in pages.items() if page in around), self.current))
            host.query_one(Tabs).active = f"tab-{self.current}"
        self.arrange_side_by_side()
        if host.query_one(LessonList) in around:
            self._focus(self.current)


class LessonCommands:
    """Runs the commands of the current lesson's text, in a terminal."""

    def __init__(self, host: HostScreen, pages: Pages) -> None:
        self._host, self._pages = host, pages
        host.register(commands.LESSON_COMMAND, self.choose, lambda: bool(self._commands))

    @property
    def _commands(self) -> tuple[str, ...]:
        return commands_in(self._host.model.lesson.body)

    def choose(self) -> None:
        """Let the learner choose one of the lesson's commands, and run it."""
        from tutor.tui.dialogs.simple import ChooseCommandScreen

        def chosen(command: str | None) -> None:
            if command is not None:
                self.run(command)

        self._host.app.push_screen(ChooseCommandScreen(self._commands), chosen)

    def run(self, command: str) -> None:
        """Show the terminal page, and type a command there, with Enter."""
        self._host.show_page("terminal")
        self._pages.open_terminal().run_line(command)
