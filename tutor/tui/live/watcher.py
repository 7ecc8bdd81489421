"""The watcher process as the live page uses it: started, asked, and ended."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from tutor.live.protocol import Follow, Plot, SetVisible, Update, WatcherRequest
from tutor.tui.live.child import LiveChild
from tutor.tui.live.launching import WatcherCommand
from tutor.tui.live.state import LiveState


class Watcher:
    """Runs the watcher process, one run at a time.

    `on_update` gets each of its updates. `on_end` is called once a run has ended; `failure` then says why, and is empty
    if it was stopped.
    """

    def __init__(self, state: LiveState, on_update: Callable[[Update], object], on_end: Callable[[], object]) -> None:
        self.child: LiveChild | None = None
        self.failure = ""
        self._state = state
        self._on_update = on_update
        self._on_end = on_end
        self._page_visible = False

    async def run(self, command: Callable[[], WatcherCommand]) -> None:
        """Watch until the process ends; cancel to end it. `command` is called in a thread."""
        child: LiveChild | None = None
        failure = "ended by itself"
        try:
            found = await asyncio.to_thread(command)
            self._state.domain = found.domain
            self.child = child = await LiveChild.start(found)
            child.send(SetVisible(self._page_visible))
            for view in self._state.topics.values():
                child.send(Follow(view.topic))
                if view.path:
                    child.send(Plot(view.topic, view.path))
            async for update in child.updates():
                self._on_update(update)
            failure = child.last_error_line or failure
        except asyncio.CancelledError:
            failure = ""
            raise
        except (OSError, ValueError) as error:
            failure = str(error)
        finally:
            if child is not None:
                child.detach()
            self.child = None
            self.failure = failure
            self._state.reset_domain()
            self._on_end()
            if child is not None:
                await child.stop()

    def send(self, request: WatcherRequest) -> None:
        """Send a request; dropped while no process runs."""
        if self.child is not None:
            self.child.send(request)

    def set_page_visible(self, visible: bool) -> None:
        """Tell the process, and those that run later, whether the page is visible."""
        self._page_visible = visible
        self.send(SetVisible(visible))
