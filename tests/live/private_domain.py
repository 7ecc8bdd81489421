"""A private ROS domain with nodes on it, and an app that shows only the live page."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import ClassVar

from textual.app import ComposeResult

from tests.ros.ordinary_domain import ordinary_domain
from tutor import private_folders
from tutor.ros.environment import detect, learner_env
from tutor.tui import messages
from tutor.tui.live.pane import LivePane
from tutor.tui.live.watcher import WatcherCommand, watcher_command
from tutor.tui.text_app import TextApp
from tutor.tui.themes import DARK, LIGHT

METRONOME = Path(__file__).with_name("metronome.py")
THERMOMETER = Path(__file__).with_name("thermometer.py")


class PrivateDomain:
    """A ROS domain that nothing else uses, limited to this host."""

    def __init__(self, domain: int) -> None:
        self.domain = domain
        self.environ = {
            **os.environ,
            "ROS_DOMAIN_ID": str(domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        }
        self._running: list[subprocess.Popen[bytes]] = []

    def run(self, script: Path, *arguments: str) -> subprocess.Popen[bytes]:
        """Start a node, and wait until it prints that it is ready."""
        ros = detect(self.environ)
        env = learner_env(
            ros,
            domain_id=self.domain,
            log_dir=private_folders.logs({}),
            package_root=None,
            isolated=False,
            environ=self.environ,
        )
        process = subprocess.Popen(
            [str(ros.python), str(script), *arguments],
            env=env,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        self._running.append(process)
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
        return process

    def interrupt(self, process: subprocess.Popen[bytes]) -> None:
        """Send SIGINT and wait for the exit, so that the node leaves the graph at once."""
        process.send_signal(signal.SIGINT)
        process.wait(10)

    def end(self, process: subprocess.Popen[bytes]) -> None:
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()
        self._running.remove(process)

    def close(self) -> None:
        for process in list(self._running):
            self.end(process)

    def read_line(self, process: subprocess.Popen[bytes]) -> str:
        """Return the next line that a node prints."""
        assert process.stdout is not None
        return process.stdout.readline().decode().strip()

    def command(self) -> WatcherCommand:
        """Return the command with which the app watches this domain."""
        return watcher_command(self.domain, self.environ)


@contextmanager
def private_domain() -> Iterator[PrivateDomain]:
    with ordinary_domain() as domain:
        private = PrivateDomain(domain)
        try:
            yield private
        finally:
            private.close()


class LiveApp(TextApp[int]):
    """The live page alone."""

    CSS: ClassVar[str] = "LivePane { height: 1fr; }"

    def __init__(self, ros_world: PrivateDomain) -> None:
        super().__init__()
        self.ros_world = ros_world
        self.errors: list[str] = []
        for theme in (DARK, LIGHT):
            self.register_theme(theme)
        self.theme = DARK.name
        self.animation_level = "none"

    def compose(self) -> ComposeResult:
        yield LivePane(id="live")

    def on_mount(self) -> None:
        self.pane.start_watching(self.ros_world.command)
        self.pane.focus_content()

    @property
    def pane(self) -> LivePane:
        return self.query_one(LivePane)

    def on_error_occurred(self, message: messages.ErrorOccurred) -> None:
        self.errors.append(message.text)


if __name__ == "__main__":  # to look around by hand: python -m tests.live.private_domain
    with private_domain() as ros_world:
        ros_world.run(THERMOMETER, *sys.argv[1:])
        LiveApp(ros_world).run()
