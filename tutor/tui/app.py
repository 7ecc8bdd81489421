"""The terminal app itself: themes, the way in, and the way out."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Iterable
from typing import Any

from textual.app import App, SystemCommand
from textual.screen import Screen

from tutor.tui.desk import Desk
from tutor.tui.screens.main import MainScreen
from tutor.tui.screens.welcome import WelcomeScreen
from tutor.tui.themes import DARK, LIGHT
from tutor.workspace import StorageError, WorkspaceError


class TutorApp(App[int]):
    """Opens on the welcome screen where there is no workspace yet, else on the lessons."""

    TITLE = "ROS Tutor"
    # An emoji is two cells wide in some terminals and one in others.
    CSS = """
    SearchIcon { display: none; }
    CommandPalette > Vertical { max-width: 84; border: round $border; background: $surface; }
    """

    def __init__(self, desk: Desk) -> None:
        super().__init__()
        self.desk = desk
        self.main: MainScreen | None = None
        self._leaving = False
        self.register_theme(DARK)
        self.register_theme(LIGHT)
        self.theme = DARK.name

    def get_default_screen(self) -> Screen[Any]:
        return Screen()

    async def on_mount(self) -> None:
        self.desk.notify = self._tell
        loop = asyncio.get_running_loop()
        for number in (signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(number, self.leave)
        if self.desk.workspace.exists:
            self._begin()
        else:
            self.push_screen(WelcomeScreen(self.desk.course, self.desk.workspace.root), self._create)

    def _tell(self, text: str) -> None:
        # Told from worker threads: a message queue is the way to the app's own thread.
        self.call_later(self.notify, text, severity="warning", timeout=12, markup=False)

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """None of Textual's own: ours are in the palette already."""
        return ()

    async def _create(self, wanted: bool | None) -> None:
        """Create the workspace, with the first exercise in it."""
        try:
            await asyncio.to_thread(self.desk.start, self.desk.lessons[0])
        except (WorkspaceError, StorageError) as error:
            self.notify(str(error), title="No workspace yet", severity="error", timeout=12, markup=False)
        self._begin()

    def _begin(self) -> None:
        state = self.desk.app_state()
        if state.theme in (DARK.name, LIGHT.name):
            self.theme = state.theme
        self.main = MainScreen(self.desk, state)
        self.push_screen(self.main)

    def action_switch_theme(self) -> None:
        """Dark to light and back."""
        self.theme = LIGHT.name if self.current_theme.dark else DARK.name

    async def action_quit(self) -> None:
        """End the check and the node, then leave. Asked a second time: leave at once (they are killed)."""
        self.leave()

    def leave(self) -> None:
        """Begin to leave."""
        if self._leaving or self.main is None:
            self.exit(0)
            return
        self._leaving = True
        if self.main.busy:
            self.notify("Ending your node and the check. Press q again to leave at once.", timeout=20)
        self.run_worker(self._leave(self.main), group="leave", exit_on_error=False)

    async def _leave(self, main: MainScreen) -> None:
        try:
            await main.close_down()
        finally:
            self.exit(0)
