"""The small dialogs: a question, a choice, or a text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.content import Content
from textual.widgets import Button, OptionList, Static

from tutor.content import CriterionText, Lesson
from tutor.tui import wording
from tutor.tui.dialogs.dialog import Dialog
from tutor.tui.widgets.attempts import format_attempts
from tutor.tui.widgets.code_view import CodeView
from tutor.tui.widgets.diffing import diff_rows
from tutor.workspace import ExerciseProgress


class ConfirmScreen(Dialog[bool]):
    """Returns True for yes. Enter means yes; Escape means no and returns None."""

    def __init__(self, title: str, text: str, yes: str, no: str = "Not now") -> None:
        super().__init__()
        self._title_text, self._text, self._yes, self._no = title, text, yes, no

    def compose(self) -> ComposeResult:
        with Vertical(classes="window") as window:
            window.border_title = Content(self._title_text)
            yield Static(self._text, classes="dialog-text", markup=False)
            with Horizontal(classes="dialog-buttons"):
                yield Button(Content(self._no), id="no")
                yield Button(Content(self._yes), id="yes")

    def on_mount(self) -> None:
        self.query_one("#yes", Button).focus()

    @on(Button.Pressed)
    def _answer(self, event: Button.Pressed) -> None:
        self.dismiss(event.button.id == "yes")


class ChooseCommandScreen(Dialog[str]):
    """Returns the command chosen."""

    DEFAULT_CSS = """
    ChooseCommandScreen OptionList { height: auto; max-height: 20; border: none; background: $surface; }
    ChooseCommandScreen OptionList:focus { border: none; }
    """

    def __init__(self, commands: Sequence[str]) -> None:
        super().__init__()
        self._commands = commands

    def compose(self) -> ComposeResult:
        with Vertical(classes="window") as window:
            window.border_title = "Run a command of the lesson"
            window.border_subtitle = "Enter runs it in the terminal · Esc closes"
            yield OptionList(*(Content(command) for command in self._commands))

    @on(OptionList.OptionSelected)
    def _chosen(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        self.dismiss(self._commands[event.option_index])


class ConflictScreen(Dialog[bool]):
    """Returns True for the learner's version, False (or None, on Esc) for the file's. Nothing is lost either way."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("d", "difference", "Difference")]

    def __init__(self, name: str, backup: str, ours: str, theirs: str) -> None:
        super().__init__()
        self._name_text, self._backup, self._ours, self._theirs = name, backup, ours, theirs

    def compose(self) -> ComposeResult:
        with Vertical(classes="window") as window:
            window.border_title = Content(f"{self._name_text} was changed outside")
            text = (
                "The file has changed on disk while you had unsaved changes here.\n\n"
                f"Both versions are safe: yours is kept as {self._backup}.\nWhich one do you want to continue with?"
            )
            yield Static(text, classes="dialog-text", markup=False)
            yield CodeView(id="conflict-difference")
            with Horizontal(classes="dialog-buttons"):
                yield Button("See the difference", id="difference")
                yield Button("Take the file's", id="theirs")
                yield Button("Keep mine", id="mine")

    def on_mount(self) -> None:
        self.query_one(CodeView).display = False
        self.query_one("#mine", Button).focus()

    @on(Button.Pressed, "#difference")
    def action_difference(self) -> None:
        """Show or hide the diff from the file's version (-) to the learner's (+)."""
        view = self.query_one(CodeView)
        view.show_rows(*diff_rows(self._theirs, self._ours))
        view.display = not view.display

    @on(Button.Pressed, "#mine")
    @on(Button.Pressed, "#theirs")
    def _answer(self, event: Button.Pressed) -> None:
        self.dismiss(event.button.id == "mine")


class HintScreen(Dialog[bool]):
    """Shows the hint for `failed` (if any) and the first `shown` general hints; returns True to ask for another."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("h", "another", "Next hint"),
        Binding("enter", "close", show=False),
    ]

    def __init__(self, lesson: Lesson, shown: int, failed: CriterionText | None = None) -> None:
        super().__init__()
        self._lesson, self._shown, self._failed = lesson, shown, failed

    def compose(self) -> ComposeResult:
        hints, name = self._lesson.hints, wording.label(self._lesson)
        more = f"h: {'next' if self._shown else 'general'} hint · " if self._shown < len(hints) else ""
        parts: list[Content | str | tuple[str, str]] = []
        if self._failed is not None:
            parts += [("✗ ", "bold $bad"), (self._failed.id, "bold"), "  ", (self._failed.text, "$quiet"), "\n"]
            parts += [self._failed.hint, "\n\n" if self._shown else ""]
        for number, hint in enumerate(hints[: self._shown], start=1):
            last = number == self._shown
            parts += [
                (f"{number}  ", "bold $accent"),
                (hint, "bold" if last and number > 1 else ""),
                "" if last else "\n\n",
            ]
        with VerticalScroll(classes="window") as window:
            count = f"hint {self._shown} of {len(hints)}" if self._shown else "a hint for what failed"
            window.border_title = Content(f"{name}: {count}")
            window.border_subtitle = f"{more}Esc closes"
            yield Static(Content.assemble(*parts), classes="dialog-text")

    def action_another(self) -> None:
        """Ask for the next hint, if there is one."""
        if self._shown < len(self._lesson.hints):
            self.dismiss(True)


class AttemptsScreen(Dialog[None]):
    """The attempts at one exercise, latest first."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("a", "close", show=False),
        Binding("q", "close", show=False),
    ]

    def __init__(self, lesson: Lesson, progress: ExerciseProgress) -> None:
        super().__init__()
        self._lesson, self._progress = lesson, progress

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="window") as window:
            window.border_title = Content(f"{wording.label(self._lesson)}: your attempts")
            window.border_subtitle = "Esc closes"
            yield Static(format_attempts(self._lesson, self._progress, max_count=200), classes="dialog-text")
