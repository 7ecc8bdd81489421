"""The main screen: the lesson list, and the current lesson's pages (text, code, log, live, terminal) and criteria."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.command import Provider
from textual.containers import Container, Horizontal, Vertical
from textual.widget import Widget
from textual.widgets import ContentSwitcher, ListView, Tab, Tabs, TextArea

from tutor.content import Lesson
from tutor.session import Session
from tutor.tui import commands, messages
from tutor.tui.control.answers import Answers
from tutor.tui.control.checklist import ChecklistController
from tutor.tui.control.checks import Checks
from tutor.tui.control.editing import Editing
from tutor.tui.control.files import Files
from tutor.tui.control.host import HostScreen
from tutor.tui.control.interfaces import Interfaces
from tutor.tui.control.lessons import Lessons
from tutor.tui.control.logs import Logs
from tutor.tui.control.nodes import Nodes
from tutor.tui.control.pages import LessonCommands, Pages
from tutor.tui.control.predictions import Predictions
from tutor.tui.control.preferences import Preferences
from tutor.tui.control.records import Records
from tutor.tui.control.reports import Reports
from tutor.tui.control.skeletons import Skeletons
from tutor.tui.control.standing import Standing
from tutor.tui.control.views import Views
from tutor.tui.model import AppModel
from tutor.tui.palette import Actions, LessonText
from tutor.tui.widgets.code_body import CodeBody
from tutor.tui.widgets.code_pane import CodePane
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.editor import CodeEditor
from tutor.tui.widgets.key_footer import KeyFooter
from tutor.tui.widgets.lesson_list import LessonList, LessonRow
from tutor.tui.widgets.lesson_view import LessonView
from tutor.tui.widgets.log_pane import LogPane
from tutor.tui.widgets.status_bar import StatusBar
from tutor.workspace import AppState


class MainScreen(HostScreen):
    """Composes the widgets, and passes messages on to the controllers, which do the work."""

    CSS_PATH = Path(__file__).with_name("main.tcss")
    BINDINGS: ClassVar[list[BindingType]] = commands.bindings()
    COMMANDS: ClassVar[set[type[Provider] | Callable[[], type[Provider]]]] = {Actions, LessonText}
    AUTO_FOCUS = "#lesson"

    def __init__(self, session: Session, state: AppState) -> None:
        super().__init__()
        self.model = AppModel.of(session, state)
        self._code, self._log = code, log = CodePane(id="code"), LogPane(id="log")
        self.preferences = Preferences(self)
        self.pages = Pages(self, self.preferences, lambda: bool(self.nodes.running))
        self.records = Records(self)
        self.files = Files(self, code)
        self.skeletons = Skeletons(self, self.files, self.records)
        self.editing = Editing(self, code, self.files, self.skeletons)
        Views(self, code, self.files, self.records)
        self.nodes = Nodes(self, self.files, self.skeletons, self.preferences)
        self.reports = Reports(self, self.pages, self.preferences)
        self.standing = Standing(self, self.reports)
        show = self.standing.show_findings
        self.checks = Checks(self, self.files, self.skeletons, self.records, self.preferences, show)
        Answers(self, self.files, self.skeletons, self.nodes, self.checks)
        self.lessons = Lessons(self, self.pages, self.files, self.preferences, self.standing)
        self.checklist = ChecklistController(self, self.records)
        self.interfaces = Interfaces(self, self.pages.restart_live)
        Predictions(self, self.records)
        self.logs = Logs(self, log, self.nodes, self.pages)
        self.lesson_commands = LessonCommands(self, self.pages)
        self.register(commands.THEME, self._switch_theme)
        self.register(commands.HELP, self._show_help)
        self.register(commands.QUIT, lambda: self.app.run_action("quit"))
        self._framed_panels: tuple[Widget, ...] = ()
        self._was_shown = False

    def compose(self) -> ComposeResult:
        self.pages.choose_layout(*self.app.size)  # before the widgets are styled for the first time
        yield StatusBar()
        with Horizontal(id="columns"):
            yield LessonList(self.model.session.lessons, id="lessons")
            with Container(id="work"):
                with Vertical(id="centre"):
                    yield Tabs(*(Tab(name.capitalize(), id=f"tab-{name}") for name in commands.PAGES), id="tabs")
                    with ContentSwitcher(initial="lesson", id="pages"):
                        yield LessonView(id="lesson")
                        yield self._code
                        yield self._log
                        yield Container(id="live")
                        yield Container(id="terminal")
                yield CriteriaPanel(id="criteria")
        yield KeyFooter(compact=True)

    async def on_mount(self) -> None:
        self._framed_panels = (self.query_one("#pages"), self.query_one(CriteriaPanel))
        self.watch_focused(self.focused)
        self.query_one(LessonList).border_title = "Lessons"
        self.query_one(StatusBar).show_nodes((), self.model.session.domain)
        self.query_one(StatusBar).show_check(None)
        self.preferences_changed()
        page = self.model.state.page
        self.pages.show_criteria_tab()
        await self.go_to(self.model.lesson, page if page in commands.PAGES else "lesson")
        self.records.read_all()
        self.interfaces.watch()

    # --- commands ---

    def action_show_criterion(self, id: str) -> None:
        """Show the report of one criterion."""
        self.query_one(CriteriaPanel).choose(id)

    def action_show_file(self, index: int) -> None:
        """Show the lesson's file at this index."""
        self.files.show(index)

    def _switch_theme(self) -> None:
        self.app.theme = "ros-tutor-light" if self.app.current_theme.dark else "ros-tutor-dark"
        self.preferences.update(theme=self.app.theme)

    def _show_help(self) -> None:
        from tutor.tui.dialogs.help import HelpScreen

        self.app.push_screen(HelpScreen())

    # --- lessons ---

    async def go_to(self, lesson: Lesson, page: str = "lesson") -> None:
        await self.lessons.go_to(lesson, page)

    async def go_to_line(self, lesson: Lesson, line: int) -> None:
        await self.lessons.go_to_line(lesson, line)

    @on(ListView.Selected, "#lessons")
    async def _lesson_chosen(self, event: ListView.Selected) -> None:
        if isinstance(event.item, LessonRow):
            await self.go_to(event.item.lesson)

    # --- pages ---

    @property
    def page(self) -> str:
        return self.pages.current

    @property
    def chosen_criterion(self) -> str:
        chosen = self.query_one(CriteriaPanel).chosen
        return chosen.id if chosen is not None else ""

    def show_page(self, name: str) -> None:
        self.pages.show(name)

    @on(Tabs.TabActivated, "#tabs")
    def _tab_chosen(self, event: Tabs.TabActivated) -> None:
        self.pages.tab_chosen((event.tab.id or "").removeprefix("tab-"))

    def watch_focused(self, focused: Widget | None) -> None:
        """Frame the panel that has the focus.

        `:focus-within` would do the same, but each change of focus would restyle every widget in the panel, and a
        lesson's text has hundreds.
        """
        around = focused.ancestors if focused is not None else []
        if self._framed_panels:
            criteria = self.query_one(CriteriaPanel)
            criteria.show_typing(self._letters_are_typed)
            criteria.set_focus_inside(criteria in around)
        for panel in self._framed_panels:
            if panel.has_class("-focused") != (panel in around):
                panel.set_class(panel in around, "-focused", update=False)
                self.app.stylesheet.update_nodes([panel])

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Do not restyle every widget at the start: each has just been styled as it was mounted."""
        event.refresh_styles = event.refresh_styles and self._was_shown
        self._was_shown = True

    def on_resize(self, event: events.Resize) -> None:
        """Lay the panels out for the new size."""
        self.pages.arrange(event.size.width, event.size.height)
        if event.size == self.outer_size:
            event.prevent_default()  # what the layout for this size has reported: Textual would do it once more

    # --- messages from workers and widgets ---

    @on(messages.ProgressRead)
    def _progress_read(self, message: messages.ProgressRead) -> None:
        self.standing.progress_read(message)
        self.checklist.show()

    @on(messages.LastChecksRead)
    def _last_checks_read(self, message: messages.LastChecksRead) -> None:
        self.checks.restore(message.last)
        self.standing.show_findings_of_lesson()

    @on(messages.AttemptRecorded)
    def _attempt_recorded(self, message: messages.AttemptRecorded) -> None:
        self.reports.attempt_recorded(message.result)

    @on(messages.Started)
    def _started(self, message: messages.Started) -> None:
        self.skeletons.started(message)

    @on(messages.RunCommand)
    def _run_command(self, message: messages.RunCommand) -> None:
        self.lesson_commands.run(message.command)

    @on(messages.FileTouched)
    def _file_touched(self, message: messages.FileTouched) -> None:
        self.files.touched(message)

    @on(messages.FileRead)
    def _file_read(self) -> None:
        self.checks.compare_files()

    @on(messages.FileSaved)
    def _file_saved(self, message: messages.FileSaved) -> None:
        self.nodes.saved(message)
        self.checks.saved(message)

    @on(messages.GoToLine)
    def _go_to_line(self, message: messages.GoToLine) -> None:
        self.editing.go_to(message)

    @on(TextArea.Changed, "CodeEditor")
    def _typed(self) -> None:
        self.files.typed()
        self.checks.edited()

    @on(messages.EditorLeft)
    def _editor_left(self) -> None:
        self._code.leave_editor()
        self.start_worker(self.files.save_all, group="save")

    @on(messages.EditWanted)
    def _edit_wanted(self, message: messages.EditWanted) -> None:
        self.editing.edit(message.text)

    @on(CodeBody.GuardChanged)
    def _guard_changed(self) -> None:
        self._code.refresh_head()
        self.query_one(CriteriaPanel).show_typing(self._letters_are_typed)
        self.refresh_bindings()

    @property
    def _letters_are_typed(self) -> bool:
        """Whether letters are no commands where the focus is."""
        return isinstance(self.focused, CodeEditor) or self._code.guarded

    @on(messages.NodeChanged)
    def _node_changed(self, message: messages.NodeChanged) -> None:
        self.logs.node_changed(message)

    @on(messages.NodeChosen)
    def _node_chosen(self, message: messages.NodeChosen) -> None:
        self.nodes.choose(message.path)

    @on(messages.ErrorOccurred)
    def _error_occurred(self, message: messages.ErrorOccurred) -> None:
        self.say(message.text, warn=True)

    def preferences_changed(self) -> None:
        state = self.model.state
        self.query_one(StatusBar).show_toggles(check=state.check_on_save, restart=state.restart_on_save)

    # --- shutdown ---

    @property
    def busy(self) -> bool:
        """Whether a check, a node or a program in a terminal is running."""
        terminal = self.pages.terminal
        terminal_busy = terminal is not None and terminal.busy
        return self.checks.running is not None or bool(self.nodes.running) or terminal_busy
