"""The watcher process as the live page uses it: started, asked, and ended. Its crash does not affect the app."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import AsyncIterator, Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from tutor import interpreter
from tutor.live.protocol import Follow, Plot, SetVisible, Update, WatcherRequest, decode_update, encode_request
from tutor.process.line_child import LineChild
from tutor.tui.live.state import LiveState

_STOP_TIMEOUT_S = 1.5
"""Grace period in seconds between closing the child's stdin and SIGKILL."""

_MAX_UNSENT_BYTES = 1 << 20


@dataclass(frozen=True, slots=True)
class WatcherCommand:
    """The child's command and complete environment; `domain` is the ROS domain that it watches."""

    argv: tuple[str, ...]
    env: Mapping[str, str]
    domain: int


def watcher_command(
    domain: int, environ: Mapping[str, str] = os.environ, *, workspace: Path | None = None
) -> WatcherCommand:
    """Return the command to watch a domain, with the discovery settings of the user's own nodes. Reads the disk.

    `workspace`: the one whose built message types are known to it.
    """
    from tutor.ros import workspace_interfaces
    from tutor.ros.environment import detect, tutor_env  # late import: keeps the first paint fast

    env = tutor_env(detect(environ), isolated=False, environ=environ)
    if workspace is not None:
        workspace_interfaces.add(env, workspace)
    return WatcherCommand(interpreter.module_command("tutor.live"), {**env, "ROS_DOMAIN_ID": str(domain)}, domain)


class LiveChild(LineChild):
    """One run of `python -m tutor.live`. It exits at the end of its stdin, and so whenever and however the app ends."""

    @classmethod
    async def start(cls, command: WatcherCommand) -> LiveChild:
        """Start the child outside of the learner's folder. Raises OSError.

        Call this on the app's main thread: the child is killed when the thread that started it ends.
        """
        return await cls._start(command.argv, Path("/"), env=command.env, stdin=asyncio.subprocess.PIPE)

    def send(self, request: WatcherRequest) -> None:
        """Send a request. Never blocks; requests to a dead or stuck child are dropped."""
        assert self._process.stdin is not None
        transport = self._process.stdin.transport
        if not transport.is_closing() and transport.get_write_buffer_size() < _MAX_UNSENT_BYTES:
            self._process.stdin.write(encode_request(request).encode() + b"\n")

    async def updates(self) -> AsyncIterator[Update]:
        """Yield the child's updates until it ends. Raises ValueError for a line that is not an update."""
        async for line in self.lines():
            yield decode_update(line)

    def detach(self) -> None:
        """Close the child's stdin, after which it soon exits on its own."""
        assert self._process.stdin is not None
        self._process.stdin.close()

    async def stop(self) -> None:
        """End the child, and wait until it is gone."""
        self.detach()
        try:
            await asyncio.wait_for(self._process.wait(), _STOP_TIMEOUT_S)
        except TimeoutError:
            self.kill()
            await self._process.wait()
        finally:
            self._reader.cancel()

    def kill(self) -> None:
        """Send SIGKILL, as the last resort."""
        self.send_signal(signal.SIGKILL)

    @property
    def last_error_line(self) -> str:
        """The last non-empty line that the child wrote to stderr."""
        return next((line for line in reversed(self.output_tail) if line.strip()), "")


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
