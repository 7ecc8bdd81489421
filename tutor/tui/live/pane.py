"""The live page: what the nodes on the user's own domain really do."""

from __future__ import annotations

from collections.abc import Callable

from textual.app import ComposeResult
from textual.containers import Vertical
from textual.widgets import Static

from tutor.content import Lesson
from tutor.tui.live.command import LiveCommand, live_command


class LivePane(Vertical):
    """Topics, parameters, services and the graph, fed from real DDS by a child process.

    Mount `LivePane(id="live")` anywhere; it costs nothing until it watches. The screen around it calls

    - `start_watching()` when the page is first opened, or a node of the learner runs. Returns at once; asked again, it
      does nothing while it watches. A test passes a function that gives another `LiveCommand`; it is called in a
      worker thread.
    - `stop_watching()` to end it; returns at once, and the child ends for certain. `await close_down()` does the same and
      waits (well under two seconds). A pane that is unmounted, or whose app is killed, ends its child as well.
    - `show_for(lesson)` when another lesson is shown: its topic, node and service are chosen as soon as they appear,
      unless the learner has chosen others.
    - `focus_content()` to put the focus where the arrow keys are of use.

    It posts `tutor.tui.messages.Trouble` (bubbles up to the screen, for a toast). Keys in it: [ and ] turn its own tabs,
    Enter chooses, Space pauses; the footer shows those that go. Single letters of the screen go on working, except in
    the inputs of its forms.
    """

    DEFAULT_CSS = "LivePane { background: $surface; }"

    def compose(self) -> ComposeResult:
        yield Static("Nothing is watched yet.", id="live-empty")

    def start_watching(self, command: Callable[[], LiveCommand] = live_command) -> None:
        """Start the child process that watches, unless it runs."""

    def stop_watching(self) -> None:
        """End the child process."""

    async def close_down(self) -> None:
        """End the child process, and wait until it is gone."""

    def show_for(self, lesson: Lesson) -> None:
        """Choose what this lesson is about, once it appears."""

    def focus_content(self) -> None:
        """Focus what the arrow keys move in."""
