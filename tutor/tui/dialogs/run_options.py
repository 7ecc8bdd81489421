"""A form for parameters and remaps, with a preview of the resulting command line."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import Button, Static, TextArea

from tutor.bundled_ros.ros2.starting import is_launch_file
from tutor.content import LessonFile
from tutor.session import run_options
from tutor.tui.dialogs.dialog import Dialog
from tutor.workspace import RunOptions


class RunOptionsScreen(Dialog[tuple[RunOptions, bool]]):
    """Returns the options, and whether to run now. `format_command` gives the command line for a set of options."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("f5", "run", "Run"), Binding("ctrl+s", "keep", "Keep")]

    def __init__(self, file: LessonFile, options: RunOptions, format_command: Callable[[RunOptions], str]) -> None:
        super().__init__()
        self._file, self._options, self._format_command = file, options, format_command
        self._is_launch = is_launch_file(file.skeleton)

    def compose(self) -> ComposeResult:
        with Vertical(classes="window") as window:
            window.border_title = Content(f"Run {self._file.name} with")
            window.border_subtitle = "F5 runs · Ctrl+S keeps · Esc cancels"
            kind = "Launch arguments" if self._is_launch else "Parameters"
            example = "topic:=my_topic" if self._is_launch else "publish_rate:=2.0"
            yield Static(_label(kind, f"one per line, as in {example}"))
            yield TextArea("\n".join(self._options.parameters), id="run-parameters", classes="dialog-lines")
            if not self._is_launch:
                yield Static(_label("Remaps", "one per line, as in chatter:=/news or __ns:=/robot1"))
                yield TextArea("\n".join(self._options.remaps), id="run-remaps", classes="dialog-lines")
            yield Static(id="run-typed")
            with Horizontal(classes="dialog-buttons"):
                yield Button("Keep", id="keep")
                yield Button("Run", id="run")

    def on_mount(self) -> None:
        self.query_one("#run-parameters", TextArea).focus()
        self._show()

    @property
    def options(self) -> RunOptions:
        """The options entered."""
        remaps = () if self._is_launch else run_options.lines(self.query_one("#run-remaps", TextArea).text)
        return RunOptions(run_options.lines(self.query_one("#run-parameters", TextArea).text), remaps)

    @on(TextArea.Changed)
    def _show(self) -> None:
        options = self.options
        if problem := run_options.problem(options, launch=self._is_launch):
            text = Content.assemble(("! ", "bold $bad"), (problem, "$bad"))
        else:
            text = Content.assemble(("As you would type it:\n", "$quiet"), (self._format_command(options), "$good"))
        self.query_one("#run-typed", Static).update(text)

    @on(Button.Pressed, "#run")
    def action_run(self) -> None:
        """Save the options and run."""
        self._finish(run=True)

    @on(Button.Pressed, "#keep")
    def action_keep(self) -> None:
        """Save the options."""
        self._finish(run=False)

    def _finish(self, *, run: bool) -> None:
        if not run_options.problem(self.options, launch=self._is_launch):
            self.dismiss((self.options, run))


def _label(name: str, about: str) -> Content:
    return Content.assemble((name, "bold"), (f"   {about}", "$quiet"))
