"""Shows a lesson's hints: the one for the failed criterion, then as many general ones as were asked for."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tutor.content import CriterionText, Lesson
from tutor.tui import wording
from tutor.tui.dialogs.dialog import Dialog


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
