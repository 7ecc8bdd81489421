"""The terminal app itself: themes, the way in, and the way out."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from textual.app import SystemCommand
from textual.events import Event, Key, Paste
from textual.screen import Screen

from tutor.session import Session
from tutor.tui.screens.opening import OpeningScreen
from tutor.tui.text_app import TextApp
from tutor.tui.themes import DARK, LIGHT
from tutor.tui.typeahead import Typeahead

if TYPE_CHECKING:
    from tutor.tui.screens.main import MainScreen


class TutorApp(TextApp[int]):
    """Opens on the welcome screen where there is no workspace yet, else on the lessons."""

    TITLE = "ROS Tutor"
    # Notes come beside the tabs: further down they would cover a diagnosis.
    # An emoji is two cells wide in some terminals and one in others.
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
        self._typeahead = Typeahead(self, super().on_event)
        self._notes: list[str] = []
        session.notify = self._notes.append
        self._state = session.app_state()
        self.register_theme(DARK)
        self.register_theme(LIGHT)
        self.theme = self._state.theme if self._state.theme in (DARK.name, LIGHT.name) else DARK.name

    async def on_event(self, event: Event) -> None:
        """Keys and pastes in the order in which they were typed; those that were handed on already come back up."""
        if isinstance(event, Key | Paste) and not event.is_forwarded:
            await self._typeahead.take(event)
        else:
            await super().on_event(event)

    def get_default_screen(self) -> Screen[Any]:
        """What is painted first."""
        known = {lesson.id: lesson for lesson in self.session.lessons}
        first = known.get(self._state.lesson, self.session.lessons[0])
        return OpeningScreen(first if self.session.workspace.exists else None)

    async def on_mount(self) -> None:
        for text in self._notes:
            self._tell(text)
        self.session.notify = self._tell
        loop = asyncio.get_running_loop()
        for number in (signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(number, self.leave)
        self.screen.call_after_refresh(self._open)

    def _open(self) -> None:
        """The first paint is out: now for what takes longer."""
        if self.session.workspace.exists:
            self._begin()
            return
        from tutor.tui.screens.welcome import WelcomeScreen

        self.push_screen(WelcomeScreen(self.session), self._welcomed)

    def _tell(self, text: str) -> None:
        # Told from worker threads: a message queue is the way to the app's own thread.
        self.call_later(self.notify, text, severity="warning", timeout=12)

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """None of Textual's own: ours are in the palette already."""
        return ()

    def _welcomed(self, begun: bool | None) -> None:
        """The workspace is there: a new one, or one from before."""
        found = self.session.app_state()
        self._state = replace(found, theme=self.theme)
        self._begin()

    def _begin(self) -> None:
        from tutor.tui.screens.main import MainScreen  # late: half of all that is imported is imported here

        self.main = MainScreen(self.session, self._state)
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
        leave: Callable[[], Any] = partial(self._leave, self.main)
        self.run_worker(leave, group="leave", exit_on_error=False)

    async def _leave(self, main: MainScreen) -> None:
        try:
            await main.close_down()
        finally:
            self.exit(0)
