"""The message types that the workspace defines: built in the background, now and whenever a definition changes."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from tutor.session.interfaces import InterfaceBuilds
from tutor.tui.control.host import HostScreen
from tutor.tui.widgets.status_bar import StatusBar

_POLL_INTERVAL_S = 1.0


class Interfaces:
    """Builds in a thread, shows in the status bar that it does, and says once what cannot be built and why.

    `on_built` is called after each build that gave types which running processes do not know.
    """

    def __init__(self, host: HostScreen, on_built: Callable[[], object]) -> None:
        self._host = host
        self._on_built = on_built
        self._said: tuple[str, ...] = ()

    def watch(self) -> None:
        """Begin, for as long as the screen is there."""
        self._host.start_worker(self._watch, group="interfaces")

    async def _watch(self) -> None:
        loop = asyncio.get_running_loop()
        builds = InterfaceBuilds(self._host.model.session.workspace.root)
        while True:
            if await asyncio.to_thread(builds.have_changed):
                before = builds.prefixes
                await asyncio.to_thread(builds.build, lambda text: loop.call_soon_threadsafe(self._show_building, text))
                self._show_building("")
                self._say_problems(builds.problems)
                if builds.prefixes != before:
                    self._on_built()
            await asyncio.sleep(_POLL_INTERVAL_S)

    def _show_building(self, text: str) -> None:
        if self._host.is_mounted:
            self._host.query_one(StatusBar).show_build(text)

    def _say_problems(self, problems: tuple[str, ...]) -> None:
        for problem in problems:
            if problem not in self._said:
                self._host.say(problem, warn=True)
        self._said = problems
