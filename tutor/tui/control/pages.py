"""Which page is shown, and where the panels are."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from textual.containers import Container
from textual.widgets import ContentSwitcher, Tabs

from tutor.tui.control.remember import Memory
from tutor.tui.live.command import live_command
from tutor.tui.live.pane import TABS, LivePane
from tutor.tui.screens.layout import Criteria, Layout, layout_for
from tutor.tui.screens.stage import Deed, Stage
from tutor.tui.terminal.history import History
from tutor.tui.terminal.pane import TerminalPane
from tutor.tui.widgets.code_pane import CodePane
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.lesson_list import LessonList
from tutor.tui.widgets.lesson_view import LessonView
from tutor.tui.widgets.log_pane import LogPane

SIDE_BY_SIDE_FROM = 112
"""From so many columns on there is room for the log beside Live."""

PAGES = ("lesson", "code", "log", "live", "terminal", "criteria")


class Pages:
    """Turns pages and folds panels. Criteria have a page of their own only where there is no room beside it."""

    def __init__(self, stage: Stage, memory: Memory, node_runs: Callable[[], bool]) -> None:
        self._stage, self._memory, self._node_runs = stage, memory, node_runs
        self.current = "lesson"
        self._shape: Layout | None = None
        self.deeds = {f"page_{name}": Deed(partial(self.show, name)) for name in PAGES}
        self.deeds |= {f"live_{name}": Deed(partial(self.show_live, name)) for name in TABS}
        self.deeds["publish"] = Deed(self.publish)
        self.deeds |= {"lessons": Deed(self.toggle_lessons), "zoom": Deed(self.zoom)}
        self.deeds["side_by_side"] = Deed(self.switch_side_by_side)

    @property
    def folded(self) -> bool:
        """Whether the criteria are behind a tab."""
        return self._stage.has_class("-folded")

    def show(self, name: str) -> None:
        """Turn to a page, and focus what is on it."""
        if name == "criteria" and not self.folded:
            self._stage.remove_class("-zoomed")
            self._stage.query_one(CriteriaPanel).open()
            return
        self._turn(name)
        self._stage.query_one(Tabs).active = f"tab-{name}"
        self._focus(name)

    def show_live(self, tab: str) -> None:
        """Turn to the live page, and to one of its tabs."""
        self.show("live")
        self._open_live().turn_to(tab)

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
        if not isinstance(self._stage.focused, Tabs | LessonList):
            self._focus(name)

    def _turn(self, name: str) -> None:
        self.current = name
        self._stage.set_class(name == "criteria", "-criteria")
        if name == "live":
            self._open_live()
        elif name == "terminal":
            self.open_terminal()
        self._stage.query_one(CriteriaPanel).show_reading(name == "lesson")
        if name != "criteria":
            self._stage.query_one(ContentSwitcher).current = name
        self.put_side_by_side()
        self._memory.note(page=name)
        self._stage.refresh_bindings()

    def _focus(self, name: str) -> None:
        if name == "code":
            self._stage.query_one(CodePane).focus_content()
        elif name == "live":
            self._open_live().focus_content()
        elif name == "terminal":
            self.open_terminal().focus_content()
        else:
            target = {"log": "#log-view", "criteria": "#criteria-list"}.get(name, "#lesson")
            self._stage.set_focus(self._stage.query_one(target), scroll_visible=False)

    def _open_live(self) -> LivePane:
        """The live page, which watches from the first time on that it is opened."""
        if not (found := self.live):
            found = LivePane(id="live-pane")
            self._stage.query_one("#live", Container).mount(found)
            found.show_for(self._stage.session.lesson)
            found.nodes_run(self._node_runs())
            desk = self._stage.session.desk
            found.call_after_refresh(found.start_watching, lambda: live_command(desk.domain))
        return found

    @property
    def live(self) -> LivePane | None:
        """The live page, if it has been opened."""
        return next(iter(self._stage.query(LivePane)), None)

    def open_terminal(self) -> TerminalPane:
        """The terminal page, made the first time that it is asked for."""
        if not (found := self.terminal):
            desk = self._stage.session.desk
            found = TerminalPane(desk.shell, History(desk.typed_commands()), id="terminal-pane")
            self._stage.query_one("#terminal", Container).mount(found)
        return found

    @property
    def terminal(self) -> TerminalPane | None:
        """The terminal page, if it has been opened."""
        return next(iter(self._stage.query(TerminalPane)), None)

    # --- log and Live side by side ---

    def put_side_by_side(self) -> None:
        """Show the log beside Live, where there is something in both, and room; else the page alone."""
        stage, log, live = self._stage, self._stage.query_one(LogPane), self._stage.query_one("#live", Container)
        full = self.live is not None and log.has_class("-filled")
        wanted = stage.session.state.side_by_side and full and stage.size.width >= SIDE_BY_SIDE_FROM
        both = wanted and self.current in ("log", "live")
        if not both and not stage.has_class("-split"):
            return
        stage.set_class(both, "-split")
        for name, page in (("log", log), ("live", live)):
            page.display = both or self.current == name

    def switch_side_by_side(self) -> None:
        """Show the log beside Live from now on, or not."""
        on = not self._stage.session.state.side_by_side
        self._memory.note(side_by_side=on)
        self.put_side_by_side()
        room = self._stage.size.width >= SIDE_BY_SIDE_FROM
        text = "Log and Live are shown side by side." if on else "Log and Live are shown one at a time."
        needs = "" if room or not on else f" That takes {SIDE_BY_SIDE_FROM} columns."
        self._stage.say(text + needs)

    # --- the panels ---

    def arrange(self, width: int, height: int) -> None:
        """Lay the panels out for a size."""
        self.put_side_by_side()
        shape = layout_for(width, height)
        if shape == self._shape:
            return
        self._shape = shape
        stage, state = self._stage, self._stage.session.state
        for place in Criteria:
            stage.set_class(shape.criteria is place, f"-{place}", update=False)
        stage.set_class(not shape.lessons, "-no-lessons", update=False)
        stage.set_class(not state.lessons_shown, "-lessons-away", update=False)
        stage.set_class(state.zoomed, "-zoomed", update=False)
        stage.remove_class("-drawer", update=False)
        stage.update_node_styles()  # once for all of them: it styles the whole screen anew
        tabs = stage.query_one(Tabs)
        if shape.criteria is Criteria.FOLDED:
            tabs.show("tab-criteria")
            return
        if self.current == "criteria":
            self._turn("lesson")
            tabs.active = "tab-lesson"
        tabs.hide("tab-criteria")

    def toggle_lessons(self) -> None:
        """Show or hide the list of lessons."""
        stage, listed = self._stage, self._stage.query_one(LessonList)
        if stage.has_class("-no-lessons") or stage.has_class("-split"):
            stage.toggle_class("-drawer")
            shown = stage.has_class("-drawer")
        else:
            shown = stage.has_class("-lessons-away") or stage.has_class("-zoomed")
            stage.remove_class("-zoomed")
            stage.set_class(not shown, "-lessons-away")
            self._memory.note(lessons_shown=shown, zoomed=False)
        if shown:
            stage.set_focus(listed)
        elif stage.focused in (listed, None):
            stage.set_focus(stage.query_one(LessonView))

    def zoom(self) -> None:
        """Give the page all the room, or show the panels again."""
        self._stage.toggle_class("-zoomed")
        self._memory.note(zoomed=self._stage.has_class("-zoomed"))
