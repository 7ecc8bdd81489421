"""The first screen for a new learner: what this is, and where their work will be."""

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

from tutor.content import Counts
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
    """Returns True once the learner has begun and the workspace has been created."""

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
        self._creating = False

    def compose(self) -> ComposeResult:
        counts = Counts.of(self._session.lessons, ())
        text = f"{counts.total} exercises: write a node, run it, and have it checked."
        text += f" Then {counts.beyond} more, beyond them." if counts.beyond else ""
        with Middle(), Vertical(id="welcome"):
            yield Static(_BANNER, id="welcome-banner")
            yield Static("Learn ROS 2 by writing nodes that really run.", id="welcome-lead")
            yield Static(text, id="welcome-text")
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
        """The folder typed, as an absolute path; None if the field is empty."""
        text = self.query_one("#welcome-folder", Input).value.strip()
        return Path(os.path.abspath(Path(text).expanduser())) if text else None

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Disable the letter keys while the folder is being edited."""
        typing = isinstance(self.focused, Input)
        return typing if action == "keep" else not typing or action == "begin"

    def action_change(self) -> None:
        """Edit the folder."""
        self.query_one("#welcome-folder", Input).focus()

    def action_keep(self) -> None:
        """Finish editing the folder."""
        self.query_one("#begin", Button).focus()

    @on(Input.Changed)
    def _show_about(self) -> None:
        about, problem = _describe_folder(self.root, self._session.workspace.root)
        self._show_status(Content.styled(f"✗ {about}", "$bad") if problem else Content.styled(about, "$quiet"))
        self.query_one("#begin", Button).disabled = problem

    def _show_status(self, text: Content) -> None:
        self.query_one("#welcome-about", Static).update(text)

    @on(Button.Pressed, "#begin")
    @on(Input.Submitted)
    def action_begin(self) -> None:
        """Create the workspace and go on to the first lesson."""
        root = self.root
        if root is not None and not self._creating and not _describe_folder(root, root)[1]:
            self._creating = True
            self.query_one("#begin", Button).label = "Creating your workspace …"
            # Not a coroutine: run_worker would never await it if the screen closed before the worker starts.
            create: Callable[[], Any] = partial(self._create, root)
            self.run_worker(create)

    async def _create(self, root: Path) -> None:
        try:
            await asyncio.to_thread(self._session.create_workspace, root)
        except (WorkspaceError, StorageError) as error:
            self._creating = False
            self.query_one("#begin", Button).label = "Press Enter to try again"
            self._show_status(Content.styled(f"✗ {error}", "$bad"))
            return
        self.dismiss(True)


def _describe_folder(root: Path | None, default: Path) -> tuple[str, bool]:
    """Return what the folder will be, or what is wrong with it, and whether there is a problem."""
    if root is None:
        return "Name a folder: it need not exist yet.", True
    if Workspace(root).exists:
        return "your existing workspace: it will be opened, with its progress", False
    existing = next(folder for folder in (root, *root.parents) if folder.exists())
    if not existing.is_dir():
        return f"{short_path(existing)} is a file, not a folder", True
    if not os.access(existing, os.W_OK):
        return f"no permission to write to {short_path(existing)}", True
    if root != default:
        return f"an ordinary ROS 2 workspace; {short_path(default)} will lead to it", False
    return "an ordinary ROS 2 workspace, yours to keep", False
