"""The first thing a new learner sees: what this is, and where their work will be."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Middle, Vertical
from textual.content import Content
from textual.screen import Screen
from textual.widgets import Button, Input, Static

from tutor.errors import StorageError, WorkspaceError
from tutor.session import Session
from tutor.session.paths import short_path
from tutor.tui.widgets.key_footer import KeyFooter
from tutor.workspace import Workspace

_BANNER = """\
┏━┓┏━┓┏━┓   ╺┳╸╻ ╻╺┳╸┏━┓┏━┓
┣┳┛┃ ┃┗━┓    ┃ ┃ ┃ ┃ ┃ ┃┣┳┛
╹┗╸┗━┛┗━┛    ╹ ┗━┛ ╹ ┗━┛╹┗╸"""


class WelcomeScreen(Screen[bool]):
    """Gives True when the learner wants to begin, and the workspace is there."""

    CSS_PATH = Path(__file__).with_name("welcome.tcss")
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "begin", "Begin"),
        Binding("f", "change", "Another folder"),
        Binding("escape", "keep", "Done", key_display="Esc"),
        Binding("t", "app.switch_theme", "Theme"),
        Binding("q", "app.quit", "Quit"),
    ]

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._making = False

    def compose(self) -> ComposeResult:
        count = len(self._session.lessons)
        with Middle(), Vertical(id="welcome"):
            yield Static(_BANNER, id="welcome-banner")
            yield Static("Learn ROS 2 by writing nodes that really run.", id="welcome-lead")
            yield Static(f"{count} exercises: write a node, run it, and have it checked.", id="welcome-text")
            with Vertical(id="welcome-place"):
                yield Static(Content.assemble("Your work will be in ", ("  f: another folder", "$quiet")))
                yield Input(short_path(self._session.workspace.root), id="welcome-folder", compact=True)
                yield Static(id="welcome-about")
            yield Button("Press Enter to begin", id="begin")
        yield KeyFooter()

    def on_mount(self) -> None:
        self.query_one("#begin", Button).focus()

    @property
    def root(self) -> Path | None:
        """The folder that is named; None where none is."""
        text = self.query_one("#welcome-folder", Input).value.strip()
        return Path(os.path.abspath(Path(text).expanduser())) if text else None

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Letters type while the folder is being changed."""
        typing = isinstance(self.focused, Input)
        return typing if action == "keep" else not typing or action == "begin"

    def action_change(self) -> None:
        """Type another folder."""
        self.query_one("#welcome-folder", Input).focus()

    def action_keep(self) -> None:
        """Leave the folder as it is typed."""
        self.query_one("#begin", Button).focus()

    @on(Input.Changed)
    def _show_about(self) -> None:
        about, problem = _about(self.root, self._session.workspace.root)
        self._tell(Content.styled(f"✗ {about}", "$bad") if problem else Content.styled(about, "$quiet"))
        self.query_one("#begin", Button).disabled = problem

    def _tell(self, text: Content) -> None:
        self.query_one("#welcome-about", Static).update(text)

    @on(Button.Pressed, "#begin")
    @on(Input.Submitted)
    def action_begin(self) -> None:
        """Create the workspace and go on to the first lesson."""
        root = self.root
        if root is not None and not self._making and not _about(root, root)[1]:
            self._making = True
            self.query_one("#begin", Button).label = "Making your workspace …"
            # Given a coroutine, run_worker leaves it behind, never awaited, where the screen closes before it begins.
            begun: Callable[[], Any] = partial(self._begin, root)
            self.run_worker(begun)

    async def _begin(self, root: Path) -> None:
        try:
            await asyncio.to_thread(self._session.create_workspace, root)
        except (WorkspaceError, StorageError) as error:
            self._making = False
            self.query_one("#begin", Button).label = "Press Enter to try again"
            self._tell(Content.styled(f"✗ {error}", "$bad"))
            return
        self.dismiss(True)


def _about(root: Path | None, usual: Path) -> tuple[str, bool]:
    """What will be in the folder, and whether it cannot be there."""
    if root is None:
        return "Name a folder: it need not exist yet.", True
    if Workspace(root).exists:
        return "a workspace of yours is there: it is opened, with its progress", False
    there = next(folder for folder in (root, *root.parents) if folder.exists())
    if not there.is_dir():
        return f"{short_path(there)} is a file, not a folder", True
    if not os.access(there, os.W_OK):
        return f"you may not write to {short_path(there)}", True
    if root != usual:
        return f"an ordinary ROS 2 workspace; {short_path(usual)} will lead to it", False
    return "an ordinary ROS 2 workspace, yours to keep", False
