"""The first thing a new learner sees: what this is, and where their work will be."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Middle, Vertical
from textual.content import Content
from textual.screen import Screen
from textual.widgets import Button, Footer, Static

from tutor.content import Course
from tutor.tui import words

_BANNER = """\
┏━┓┏━┓┏━┓   ╺┳╸╻ ╻╺┳╸┏━┓┏━┓
┣┳┛┃ ┃┗━┓    ┃ ┃ ┃ ┃ ┃ ┃┣┳┛
╹┗╸┗━┛┗━┛    ╹ ┗━┛ ╹ ┗━┛╹┗╸"""


class WelcomeScreen(Screen[bool]):
    """Gives True when the learner wants to begin."""

    CSS_PATH = Path(__file__).with_name("welcome.tcss")
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "begin", "Begin"),
        Binding("t", "app.switch_theme", "Theme"),
        Binding("q", "app.quit", "Quit"),
    ]

    def __init__(self, course: Course, root: Path) -> None:
        super().__init__()
        self._course, self._root = course, root

    def compose(self) -> ComposeResult:
        count = len(self._course.lessons)
        with Middle(), Vertical(id="welcome"):
            yield Static(_BANNER, id="welcome-banner")
            yield Static("Learn ROS 2 by writing nodes that really run.", id="welcome-lead")
            yield Static(
                f"{count} exercises, each of them a real node, from its first message on. You write the code, "
                "run it, and have it checked: by what your node does, never by how it looks.",
                classes="welcome-text",
            )
            yield Static(
                Content.assemble(
                    "Your work will be in\n",
                    (words.short(self._root), "bold $primary"),
                    ("\nan ordinary ROS 2 workspace, yours to keep", "$quiet"),
                ),
                id="welcome-place",
            )
            yield Button("Press Enter to create it and begin", id="begin")
        yield Footer(show_command_palette=False)

    def on_mount(self) -> None:
        self.query_one("#begin", Button).focus()

    @on(Button.Pressed, "#begin")
    def action_begin(self) -> None:
        """Create the workspace and go on to the first lesson."""
        self.dismiss(True)
