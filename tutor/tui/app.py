"""The terminal app: themes, startup and shutdown."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from textual.app import SystemCommand
from textual.events import AppBlur, Event, Key, Paste
from textual.screen import Screen

from tutor.session import Session
from tutor.tui.key_latency import resume_collection
from tutor.tui.screens.opening import OpeningScreen
from tutor.tui.text_app import TextApp
from tutor.tui.themes import DARK, LIGHT
from tutor.tui.typeahead import Typeahead

if TYPE_CHECKING:
    from tutor.tui.screens.main import MainScreen

SAVE_LIMIT_S = 5.0
"""Timeout for saving: a save blocks while a conflict dialog is open, and by then both versions are on disk anyway."""


class TutorApp(TextApp[int]):
    """Opens the welcome screen if there is no workspace yet, else the lessons."""

    TITLE = "ROS Tutor"
    # Toasts appear beside the tabs: further down they would cover a diagnosis.
    # The search icon is hidden: an emoji is two cells wide in some terminals and one in others.
    CSS = """
    SearchIcon { display: none; }
    ToastRack { dock: top; align: right top; margin: 0; }
    Toast { padding: 0 1; }
    CommandPalette > Vertical { max-width: 84; border: round $border; background: $surface; }
    """

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        self.main: MainScreen | None = None
        self._leaving = False
        self._page_opened = False
        self._typeahead = Typeahead(self, super().on_event)
        self._early_warnings: list[str] = []
        session.notify = self._early_warnings.append
        self._state = session.app_state()
        self.register_theme(DARK)
        self.register_theme(LIGHT)
        self.theme = self._state.theme if self._state.theme in (DARK.name, LIGHT.name) else DARK.name

    async def on_event(self, event: Event) -> None:
        """Queue keys and pastes so that they take effect in the order typed; forwarded ones bubble back up here."""
        if isinstance(event, Key | Paste) and not event.is_forwarded:
            await self._typeahead.take(event)
        else:
            await super().on_event(event)

    def on_app_blur(self, event: AppBlur) -> None:
        """In a browser, ignore the first one, which Textual's driver sends: a page has the focus when it opens.

        Without the focus, the foot of the screen shows no keys, and the arrow keys move nothing.
        """
        if self.is_web and not self._page_opened:
            self._page_opened = True
            event.prevent_default()

    def get_default_screen(self) -> Screen[Any]:
        """Return the screen that is painted first."""
        return OpeningScreen(self.session.lesson_to_open(self._state) if self.session.workspace.exists else None)

    async def on_mount(self) -> None:
        for text in self._early_warnings:
            self._warn(text)
        self.session.notify = self._warn
        loop = asyncio.get_running_loop()
        for signum in (signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(signum, self.leave)
        self.screen.call_after_refresh(self._open)

    def _open(self) -> None:
        """Open the real first screen, now that the first paint is out and slow imports no longer delay it."""
        if self.session.workspace.exists:
            self._open_lessons()
            return
        from tutor.tui.screens.welcome import WelcomeScreen

        self.push_screen(WelcomeScreen(self.session), self._workspace_created)
        self.screen.call_after_refresh(resume_collection)

    def _warn(self, text: str) -> None:
        # Called from worker threads: the message queue carries it to the app's own thread.
        self.call_later(self.notify, text, severity="warning", timeout=12)

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """Return none of Textual's own commands: ours are in the palette already."""
        return ()

    def _workspace_created(self, begun: bool | None) -> None:
        """Open the lessons: the workspace now exists, be it a new or an earlier one."""
        found = self.session.app_state()
        self._state = replace(found, theme=self.theme)
        self._open_lessons()

    def _open_lessons(self) -> None:
        from tutor.tui.screens.main import MainScreen  # late: this accounts for half of all imports

        self.main = MainScreen(self.session, self._state)
        for path in self.main.css_path:
            self.stylesheet.read(path)  # now: once the widgets are there, Textual would parse all of their CSS again
        self.push_screen(self.main)
        self.main.call_after_refresh(resume_collection)

    def action_switch_theme(self) -> None:
        """Switch between the dark and the light theme."""
        self.theme = LIGHT.name if self.current_theme.dark else DARK.name

    async def action_quit(self) -> None:
        """Stop the check and the node, then quit. The second time, quit at once (they are killed)."""
        self.leave()

    def leave(self) -> None:
        """Start shutting down, or quit at once if that is under way or there is nothing to shut down."""
        if self._leaving or self.main is None:
            self.exit(0)
            return
        self._leaving = True
        if self.main.busy:
            self.notify("Ending your node and the check. Press q again to leave at once.", timeout=20)
        shut_down: Callable[[], Any] = self._shut_down
        self.run_worker(shut_down, group="leave", exit_on_error=False)

    async def _shut_down(self) -> None:
        try:
            await self.close_down()
        finally:
            self.exit(0)

    async def close_down(self) -> None:
        """Save, stop the check, the nodes and the terminals, and wait until they are all gone."""
        if (main := self.main) is None:
            return
        main.checks.shut_down()
        main.nodes.shut_down()
        if (terminal := main.pages.terminal) is not None:
            terminal.close_all()
        with suppress(TimeoutError):
            async with asyncio.timeout(SAVE_LIMIT_S):
                await main.files.save_all()
        await main.preferences.flush()
        if (live := main.pages.live) is not None:
            await live.close_down()
        busy = [worker for worker in main.workers if worker.group in ("check", "node", "progress", "terminal")]
        if busy:  # an empty list would mean all workers, and the file watcher never ends
            await self.workers.wait_for_complete(busy)
        main.files.close()
        main.workers.cancel_node(main)  # workers that still read or watch a file would find no widget to show it in
