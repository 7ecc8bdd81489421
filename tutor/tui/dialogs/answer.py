"""The answer to an exercise that hands over a system: what is wrong, and in which file."""

from __future__ import annotations

from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import OptionList, Static

from tutor.tui.dialogs.dialog import Dialog
from tutor.workspace.answering import Question


class AnswerScreen(Dialog[tuple[str, str]]):
    """Returns what is wrong, and where; what was answered before is chosen already."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("tab", "app.focus_next", show=False),
        Binding("shift+tab", "app.focus_previous", show=False),
    ]
    DEFAULT_CSS = """
    AnswerScreen .window { width: 100%; max-width: 90; }
    AnswerScreen OptionList { height: auto; border: none; background: $surface; margin-bottom: 1; padding: 0; }
    AnswerScreen OptionList:focus { border: none; }
    """

    def __init__(self, title: str, question: Question) -> None:
        super().__init__()
        self._title_text, self._report = title, question.report
        self._kinds, self._places = question.cases.kinds, question.cases.places

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="window", can_focus=False) as window:
            window.border_title = Content(self._title_text)
            window.border_subtitle = "↑↓ Enter: choose · Tab: the other list · Esc: not yet"
            yield Static(Content.styled("What is wrong?", "bold"))
            yield OptionList(*(Content(says) for says in self._kinds.values()), id="answer-what")
            yield Static(Content.styled("In which file?", "bold"))
            yield OptionList(*(Content(place) for place in self._places), id="answer-where")

    def on_mount(self) -> None:
        for name, chosen, choices in (
            ("what", self._report.what, [*self._kinds]),
            ("where", self._report.where, [*self._places]),
        ):
            self.query_one(f"#answer-{name}", OptionList).highlighted = (
                choices.index(chosen) if chosen in choices else 0
            )
        self.query_one("#answer-what", OptionList).focus()

    @on(OptionList.OptionSelected, "#answer-what")
    def _what_chosen(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        self.query_one("#answer-where", OptionList).focus()

    @on(OptionList.OptionSelected, "#answer-where")
    def _where_chosen(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        what = self.query_one("#answer-what", OptionList).highlighted
        if what is not None:
            self.dismiss(([*self._kinds][what], self._places[event.option_index]))
