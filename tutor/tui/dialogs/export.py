"""Asks in which format and to which file to export the checklist."""

from __future__ import annotations

import os
from pathlib import Path
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import Button, Input, Static

from tutor.report.checklist_formats import FORMATS, SUFFIXES, format_of
from tutor.session.paths import short_path
from tutor.tui.dialogs.dialog import Dialog

NAMES = {"markdown": "Markdown", "json": "JSON", "html": "HTML page"}

_ABOUT = {
    "markdown": "A task list as GitHub shows it, and a table of your exercises.",
    "json": "For programs: every item, its evidence, and each exercise's progress.",
    "html": "One page for any browser, to read, to print, to hand in.",
}


class ExportScreen(Dialog[tuple[str, Path]]):
    """Returns the format and the file; the caller must ask before overwriting an existing one."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "format(-1)", show=False),
        Binding("down", "format(1)", show=False),
    ]

    def __init__(self, folder: Path, format: str = FORMATS[0], file: Path | None = None) -> None:
        super().__init__()
        self._folder, self._format = folder, format
        path = file or folder / f"checklist{SUFFIXES[format]}"
        self._path_text = str(path.relative_to(folder)) if path.is_relative_to(folder) else short_path(path)

    def compose(self) -> ComposeResult:
        with Vertical(classes="window") as window:
            window.border_title = "Export the checklist"
            window.border_subtitle = "↑ ↓ format · Enter exports · Esc closes"
            with Horizontal(id="export-formats"):
                for format in FORMATS:
                    yield Button(NAMES[format], id=f"format-{format}")
            yield Static(id="export-about")
            yield Input(self._path_text, id="export-file")
            yield Static(id="export-place")
            with Horizontal(classes="dialog-buttons"):
                yield Button("Not now", id="no")
                yield Button("Export", id="yes")

    def on_mount(self) -> None:
        field = self.query_one(Input)
        field.focus()
        self._show()

    @property
    def path(self) -> Path:
        """The file typed; a relative path is relative to the workspace."""
        text = self.query_one(Input).value.strip()
        try:
            return self._folder / Path(text).expanduser()
        except RuntimeError:  # "~somebody", but there is no such user
            return self._folder / text

    def action_format(self, by: int) -> None:
        """Choose the next format (1) or the previous one (-1)."""
        self._choose(FORMATS[(FORMATS.index(self._format) + by) % len(FORMATS)])

    @on(Button.Pressed, "#export-formats Button")
    def _format_pressed(self, event: Button.Pressed) -> None:
        self._choose((event.button.id or "").removeprefix("format-"))

    def _choose(self, format: str) -> None:
        self._format = format
        field = self.query_one(Input)
        path = Path(field.value.strip())
        if format_of(path) not in (format, None):
            field.value = str(path.with_suffix(SUFFIXES[format]))
        self._show()

    @on(Input.Changed)
    def _typed(self, event: Input.Changed) -> None:
        self._format = format_of(Path(event.value.strip())) or self._format
        self._show()

    def _show(self) -> None:
        for format in FORMATS:
            button, chosen = self.query_one(f"#format-{format}", Button), format == self._format
            button.label = f"({'•' if chosen else ' '}) {NAMES[format]}"
            button.set_class(chosen, "-chosen")
        self.query_one("#export-about", Static).update(_ABOUT[self._format])
        place = short_path(self.path.parent)
        if problem := self._problem():
            text = Content.assemble(("! ", "bold $warn"), (problem, "$warn"))
        elif os.path.exists(self.path):
            text = Content.styled(f"There already, in {place}: you will be asked before it is replaced.", "$warn")
        else:
            text = Content.styled(f"A new file in {place}", "$quiet")
        self.query_one("#export-place", Static).update(text)

    def _problem(self) -> str:
        """Return what is wrong with the file, or ""."""
        path = self.path
        # Not Path.is_dir and the like: they raise PermissionError if a parent folder may not be searched.
        if not self.query_one(Input).value.strip() or os.path.isdir(path):
            return "Enter a file name."
        if not os.path.isdir(path.parent):
            return f"There is no folder {short_path(path.parent)}."
        return ""

    @on(Button.Pressed, "#yes")
    @on(Input.Submitted)
    def _export(self) -> None:
        if not self._problem():
            self.dismiss((self._format, self.path))

    @on(Button.Pressed, "#no")
    def _leave(self) -> None:
        self.dismiss(None)
