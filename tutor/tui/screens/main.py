"""The main screen: lessons, the text, code and log of one, and its criteria."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.command import Provider
from textual.containers import Container, Horizontal, Vertical
from textual.reactive import var
from textual.screen import Screen
from textual.widgets import ContentSwitcher, Footer, ListView, Tab, Tabs

from tutor.content import Lesson
from tutor.tui import messages
from tutor.tui.commands import TutorCommands, bindings
from tutor.tui.desk import Desk, domain_id
from tutor.tui.findings import Findings
from tutor.tui.following import follow
from tutor.tui.screens.help import HelpScreen
from tutor.tui.screens.layout import Criteria, Layout, layout_for
from tutor.tui.screens.work import Work
from tutor.tui.widgets.code_pane import CodePane
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.lesson_list import LessonList, LessonRow
from tutor.tui.widgets.lesson_view import LessonView
from tutor.tui.widgets.log_pane import LogPane
from tutor.tui.widgets.status_bar import StatusBar
from tutor.workspace import Progress

PAGES = ("lesson", "code", "log", "criteria")


class MainScreen(Work, Screen[None]):
    """What is shown, and where. What is done to the learner's node is in `Work`."""

    CSS_PATH = Path(__file__).with_name("main.tcss")
    BINDINGS: ClassVar[list[BindingType]] = bindings()
    COMMANDS: ClassVar[set[type[Provider] | Callable[[], type[Provider]]]] = {TutorCommands}
    AUTO_FOCUS = "#lesson"

    shape: var[Layout | None] = var(None)

    def __init__(self, desk: Desk) -> None:
        super().__init__()
        self.desk = desk
        self.lesson = desk.lessons[0]
        self.findings = {lesson.id: Findings.of(lesson) for lesson in desk.lessons}
        self.progress = Progress()
        self.file_index = 0
        self._shown_file: Path | None = None

    def compose(self) -> ComposeResult:
        yield StatusBar()
        with Horizontal(id="desk"):
            yield LessonList(self.desk.lessons, id="lessons")
            with Container(id="work"):
                with Vertical(id="centre"):
                    yield Tabs(*(Tab(name.capitalize(), id=f"tab-{name}") for name in PAGES), id="tabs")
                    with ContentSwitcher(initial="lesson", id="pages"):
                        yield LessonView(id="lesson")
                        yield CodePane(id="code")
                        yield LogPane(id="log")
                yield CriteriaPanel(id="criteria")
        yield Footer(compact=True, show_command_palette=False)

    async def on_mount(self) -> None:
        self.query_one(LessonList).border_title = "Lessons"
        self.query_one(StatusBar).show_node(None, domain_id())
        self.query_one(StatusBar).show_check(None)
        self._arrange(self.size.width, self.size.height)
        await self.go_to(self.lesson)
        self.read_progress()

    # --- which lesson ---

    async def go_to(self, lesson: Lesson) -> None:
        """Show a lesson."""
        self.lesson = lesson
        self.query_one(StatusBar).show_lesson(lesson)
        self.query_one(LessonList).show_lesson(lesson)
        self.remove_class("-drawer")
        self.show_page("lesson")
        self.action_show_file(0)
        await self.query_one(CriteriaPanel).show_lesson(self.findings[lesson.id])
        await self.query_one(LessonView).show_lesson(lesson)
        self.refresh_bindings()

    async def action_next_lesson(self) -> None:
        await self._step(1)

    async def action_previous_lesson(self) -> None:
        await self._step(-1)

    async def _step(self, by: int) -> None:
        place = self.desk.lessons.index(self.lesson) + by
        if 0 <= place < len(self.desk.lessons):
            await self.go_to(self.desk.lessons[place])
        else:
            self.notify("This is the last lesson." if by > 0 else "This is the first lesson.")

    @on(ListView.Selected, "#lessons")
    async def _lesson_chosen(self, event: ListView.Selected) -> None:
        if isinstance(event.item, LessonRow):
            await self.go_to(event.item.lesson)
            self.query_one(LessonView).focus()

    @on(messages.ProgressRead)
    def _progress_read(self, message: messages.ProgressRead) -> None:
        self.progress = message.progress
        self.query_one(LessonList).show_progress(message.progress)

    # --- which page ---

    def show_page(self, name: str) -> None:
        """Turn to a page; criteria have one of their own only where they are folded."""
        if name == "criteria" and not self.has_class("-folded"):
            self.query_one("#criteria-list").focus()
            return
        self.query_one(Tabs).active = f"tab-{name}"

    def action_tab(self, name: str) -> None:
        self.show_page(name)

    @on(Tabs.TabActivated, "#tabs")
    def _turn(self, event: Tabs.TabActivated) -> None:
        name = (event.tab.id or "").removeprefix("tab-")
        self.set_class(name == "criteria", "-criteria")
        if name != "criteria":
            self.query_one(ContentSwitcher).current = name
        if not isinstance(self.focused, Tabs | LessonList):
            target = {"code": "#code-view", "log": "#log-view", "criteria": "#criteria-list"}.get(name, "#lesson")
            self.query_one(target).focus(scroll_visible=False)

    def on_resize(self, event: events.Resize) -> None:
        """Lay the panels out for the new size."""
        self._arrange(event.size.width, event.size.height)

    def _arrange(self, width: int, height: int) -> None:
        shape = layout_for(width, height)
        if shape == self.shape:
            return
        self.shape = shape
        for place in Criteria:
            self.set_class(shape.criteria is place, f"-{place}", update=False)
        self.set_class(not shape.lessons, "-no-lessons", update=False)
        self.remove_class("-drawer", "-lessons-away", update=False)
        self.update_node_styles()  # once for all of them: it styles the whole screen anew
        tabs = self.query_one(Tabs)
        if shape.criteria is Criteria.FOLDED:
            tabs.show("tab-criteria")
        else:
            if tabs.active == "tab-criteria":
                tabs.active = "tab-lesson"
            tabs.hide("tab-criteria")

    def action_lessons(self) -> None:
        """Show or hide the list."""
        listed = self.query_one(LessonList)
        self.toggle_class("-drawer" if self.has_class("-no-lessons") else "-lessons-away")
        shown = self.has_class("-drawer") if self.has_class("-no-lessons") else not self.has_class("-lessons-away")
        if shown:
            listed.focus()
        elif self.focused in (listed, None):
            self.query_one(LessonView).focus()

    # --- which file ---

    def action_show_file(self, index: int) -> None:
        """Show one of the lesson's files, and follow it on disk."""
        self.file_index = index
        paths = [self.desk.path(file) for file in self.lesson.files]
        self.query_one(CodePane).show_names(paths, index)
        self.run_worker(follow(paths[index], self.post_message), group="file", exclusive=True)

    def action_next_file(self) -> None:
        self.action_show_file((self.file_index + 1) % len(self.lesson.files))
        self.show_page("code")

    @on(messages.FileRead)
    def _file_read(self, message: messages.FileRead) -> None:
        if message.path != self.desk.path(self.lesson.files[self.file_index]):
            return
        pane = self.query_one(CodePane)
        if message.text is None:
            pane.show_missing(message.path, message.problem)
        else:
            pane.show_source(message.text, anew=message.path != self._shown_file)
            self._shown_file = message.path
        self.refresh_bindings()

    # --- the rest ---

    def action_help(self) -> None:
        self.app.push_screen(HelpScreen())

    @on(messages.Trouble)
    def _trouble(self, message: messages.Trouble) -> None:
        self.notify(message.text, severity="warning", timeout=8, markup=False)
