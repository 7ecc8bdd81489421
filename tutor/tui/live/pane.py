"""The live page: what the nodes on the user's own domain really do."""

from __future__ import annotations

import asyncio
import gc
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.message import Message
from textual.widgets import ContentSwitcher, Static
from textual.worker import Worker

from tutor.content import Lesson
from tutor.content.near_miss import near_misses
from tutor.live.protocol import Follow, Plot, Publish, SetVisible, StopPublishing, Unfollow, Update, WatcherRequest
from tutor.live.protocol import WatcherError as ChildTrouble
from tutor.live.updates import CallOutcome, NodeParameters, PublishStatus, RequestForm, SetOutcome, TopicUpdate
from tutor.ros_model import Graph
from tutor.tui import messages
from tutor.tui.live import wording
from tutor.tui.live.child import LiveChild
from tutor.tui.live.graph_panel import GraphPanel
from tutor.tui.live.launching import WatcherCommand
from tutor.tui.live.parameters_panel import ParametersPanel
from tutor.tui.live.publish_dialog import PublishScreen
from tutor.tui.live.services_panel import ServicesPanel
from tutor.tui.live.state import LiveState
from tutor.tui.live.topics_panel import TopicsPanel, WatcherRequested
from tutor.tui.widgets.steady_static import SteadyStatic
from tutor.tui.widgets.strip import TabStrip

MOST_MISSES = 3
"""This many near-miss names are shown at once at most."""

MOST_OFFERED = 8
"""This many topics of the learner's nodes are followed unasked at most."""

SWITCH_S = 0.0005
"""How long a thread of the app may keep the others waiting."""

TABS = {"topics": "Topics", "parameters": "Parameters", "services": "Services", "graph": "Graph"}


class LivePane(Vertical):
    """Topics, parameters, services and the graph, fed from real DDS by a child process.

    Mount `LivePane(id="live")` anywhere; it costs nothing until it watches. The screen around it calls

    - `start_watching(command)` when the page is first opened, or a node of the learner runs. Returns at once; asked
      again, it does nothing while it watches. `command` is called in a worker thread.
    - `stop_watching()` to end it; returns at once, and the child ends for certain. `await close_down()` does the same
      and waits (well under two seconds). A pane that is unmounted, or whose app is killed, ends its child as well.
    - `show_for(lesson)` when another lesson is shown: its topic, node and service are chosen as soon as they appear,
      unless the learner has chosen others; topics of the one before go as soon as nobody publishes on them.
    - `nodes_run(whether)` when a node of the learner's runs, and when none does any more: while one does, what is newly
      published is followed, and shown where nothing comes on the topic that is shown.
    - `turn_to(tab)` to show one of `TABS`.
    - `focus_content()` to put the focus where the arrow keys are of use.

    It posts `tutor.tui.messages.ErrorOccurred` (bubbles up to the screen, for a toast). Keys in it: [ and ] turn its
    own tabs, Enter chooses, Space pauses, x, y, u, + and -: each panel shows those that go in its last line. Other keys
    of the screen go on working, except in the inputs of its forms.
    """

    DEFAULT_CSS = Path(__file__).with_name("pane.tcss").read_text("utf-8")
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left_square_bracket", "step(-1)", "Previous tab", show=False),
        Binding("right_square_bracket", "step(1)", "Next tab", show=False),
    ]

    class Arrived(Message):
        """The watching process has sent an update."""

        def __init__(self, update: Update) -> None:
            super().__init__()
            self.update = update

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.state = LiveState()
        self._child: LiveChild | None = None
        self._worker: Worker[None] | None = None
        self._command: Callable[[], WatcherCommand] | None = None
        self._broken = ""
        self._left: set[str] = set()
        self._own_nodes = False
        self._offered: set[str] = set()
        self._seen = False
        self._composed = False
        self._wants_focus = False
        self._wanted_tab = ""

    def compose(self) -> ComposeResult:
        with Horizontal(id="live-head"):
            yield TabStrip(TABS, id="live-tabs")
            yield SteadyStatic(id="live-status")
        yield SteadyStatic(id="live-empty")
        yield SteadyStatic(id="live-note", markup=False)
        yield SteadyStatic(id="live-miss", markup=False)
        yield SteadyStatic(id="live-publishing", markup=False)
        with ContentSwitcher(initial="topics", id="live-panels"):
            yield TopicsPanel(self.state, id="topics")
            yield ParametersPanel(self.state, id="parameters")
            yield ServicesPanel(self.state, id="services")
            yield GraphPanel(self.state, id="graph")

    def on_mount(self) -> None:
        self._composed = True
        self._show_status()
        self._choose()
        if self._wanted_tab:
            self.open_tab(self._wanted_tab)
        if self._wants_focus:
            self.focus_content()

    # --- the watching process ---

    def start_watching(self, command: Callable[[], WatcherCommand]) -> None:
        """Start the child process that watches, unless it runs."""
        if self._worker is None:
            self._command, self._broken = command, ""
            _answer_keys_sooner()
            watch: Callable[[], Any] = partial(self._watch, command)
            self._worker = self.run_worker(watch, group="live", exit_on_error=False)
            if self._composed:
                self._show_status()

    def stop_watching(self) -> None:
        """End the child process."""
        if self._worker is not None:
            self._worker.cancel()

    async def close_down(self) -> None:
        """End the child process, and wait until it is gone."""
        if (child := self._child) is not None:
            self.stop_watching()
            await child.stop()

    async def on_unmount(self) -> None:
        """End it with the pane."""
        await self.close_down()

    async def _watch(self, command: Callable[[], WatcherCommand]) -> None:
        child: LiveChild | None = None
        fault = "ended by itself"
        try:
            found = await asyncio.to_thread(command)
            self.state.domain = found.domain
            self._child = child = await LiveChild.start(found)
            child.send(SetVisible(self._seen))
            for view in self.state.topics.values():
                child.send(Follow(view.topic))
                if view.path:
                    child.send(Plot(view.topic, view.path))
            async for update in child.updates():
                self.post_message(self.Arrived(update))
            fault = child.last_error_line or fault
        except asyncio.CancelledError:
            fault = ""
            raise
        except (OSError, ValueError) as error:
            fault = str(error)
        finally:
            if child is not None:
                child.detach()
            self._child = self._worker = None
            self.state.lost()
            if self.is_attached:
                self._broken = fault
                self._show_all()
                if fault:
                    self.post_message(messages.ErrorOccurred(f"The live page no longer watches: {fault}"))
            if child is not None:
                await child.stop()

    @on(WatcherRequested)
    def _send_requested(self, message: WatcherRequested) -> None:
        message.stop()
        self._send(message.command)
        if isinstance(message.command, Follow | Unfollow):
            self._show_status()

    def _send(self, command: WatcherRequest) -> None:
        if self._child is not None:
            self._child.send(command)

    # --- what it tells ---

    @on(Arrived)
    async def _arrived(self, message: Arrived) -> None:
        message.stop()
        update = message.update
        self.state.receive(update)
        match update:
            case TopicUpdate(topic):
                self.query_one(TopicsPanel).show_update(topic)
            case Graph():
                self._drop_left()
                self._follow_own()
                self._show_all()
                await self._choose_service()
            case NodeParameters():
                self.query_one(ParametersPanel).show_list()
                self._show_status()
            case SetOutcome():
                self.query_one(ParametersPanel).show_history()
            case CallOutcome():
                self.query_one(ServicesPanel).show_history()
            case RequestForm():
                await self.query_one(ServicesPanel).show_form()
                if isinstance(self.app.screen, PublishScreen):
                    await self.app.screen.show_form(update)
            case PublishStatus():
                self._show_publishing()
            case ChildTrouble(text):
                self.post_message(messages.ErrorOccurred(text))
            case _:
                self._show_status()

    def _show_all(self) -> None:
        self.query_one(TopicsPanel).show_list()
        self.query_one(ParametersPanel).show_list()
        self.query_one(ServicesPanel).show_list()
        self.query_one(ServicesPanel).show_history()
        self.query_one(GraphPanel).show_list()
        self._show_publishing()
        self._show_status()

    def _show_status(self) -> None:
        """The tabs' counts, what is watched, and what to do where there is nothing to see."""
        state = self.state
        graph = state.graph or Graph()
        counts = {
            "topics": sum(not topic.is_standard for topic in graph.topics),
            "parameters": len(state.listed_parameters(everything=False)),
            "services": sum(not service.is_standard for service in graph.services),
            "graph": 0,
        }
        labels = {name: f"{label} {counts[name]}" if counts[name] else label for name, label in TABS.items()}
        if broken := len(state.mismatches()):
            labels["graph"] = f"Graph ✗ {broken}"
        self.query_one(TabStrip).labels = labels
        nodes = len(state.nodes)
        domain = f"domain {state.domain}"
        word = f"● {nodes} node{'' if nodes == 1 else 's'} · {domain}" if state.ready else "◐ starting"
        if self._worker is None:
            word = "! not watching" if self._broken else "not watching"
        self.query_one("#live-status", Static).update(word)
        came = any(view.update is not None and view.update.count for view in state.topics.values())
        text = self._nothing(short=came)
        was_empty = self.has_class("-empty")
        self.set_class(bool(text) and not came, "-empty")
        if was_empty and not self.has_class("-empty") and self.query_one(TabStrip).has_focus:
            self.focus_content()  # which could only focus the tabs before
        self.set_class(bool(text) and came, "-note")
        misses = [str(miss) for miss in near_misses(graph, state.asked)]
        self.set_class(bool(misses), "-miss")
        self.query_one("#live-miss", Static).update("\n".join(f"≈ {miss}" for miss in misses[:MOST_MISSES]))
        self.query_one("#live-empty" if not came else "#live-note", Static).update(text)

    def _nothing(self, short: bool) -> Content:
        """Why nothing can be seen, and what to do; empty where there is a node."""
        domain = self.state.domain
        if self._broken:
            return _advice("Nothing is watched", f"{self._broken}\nTurn to another page and back to watch again.")
        if self._worker is None:
            return _advice("Nothing is watched yet", "")
        if self.state.graph is None and not self.state.ready:
            return _advice("Joining your ROS domain", "")
        if self.state.nodes:
            return Content("")
        return Content.assemble(
            (f"No node runs in domain {domain}", "bold $foreground"),
            ": press ",
            ("r", "bold $accent"),
            " to run yours." if short else " to run yours.\nTopics, parameters, services and the graph come here.",
        )

    # --- publishing by hand ---

    def publish(self) -> None:
        """Ask what to publish; where something is published on the topic that is shown, stop that."""
        topic = self.query_one(TopicsPanel).chosen if self._composed else ""
        going = [held.topic for held in self.state.published.values() if held.rate_hz and not held.over]
        if going:
            self._send(StopPublishing(topic if topic in going else going[0]))
            return

        def answered(request: Publish | None) -> None:
            if request is not None:
                panel = self.query_one(TopicsPanel)
                panel.follow(request.topic)
                panel.post_message(WatcherRequested(request))  # after the request to follow

        self.app.push_screen(PublishScreen(topic, self._type_of, self._send), answered)

    def _type_of(self, topic: str) -> str:
        found = self.state.graph.topic(topic) if self.state.graph else None
        asked = (known.type for known in self.state.asked.topics if known.name == topic)
        return found.types[0] if found is not None else next(asked, "")

    def _show_publishing(self) -> None:
        text = "\n".join(wording.publishing(held) for held in self.state.published.values())
        self.set_class(bool(text), "-publishing")
        self.query_one("#live-publishing", Static).update(text)

    # --- what is chosen ---

    def show_for(self, lesson: Lesson) -> None:
        """Choose what this lesson is about, once it appears."""
        if lesson.live is self.state.asked:
            return
        self.state.asked = lesson.live
        self._left = {name for name in self.state.topics if not self.state.is_asked(name)}
        self._offered.clear()
        if self._composed:
            self._drop_left()
            self.query_one(TopicsPanel).chosen_by_learner = False
            self.query_one(ServicesPanel).chosen_by_learner = False
            self._choose()
            self._show_status()

    def nodes_run(self, whether: bool) -> None:
        """Whether a node of the learner's runs."""
        self._own_nodes = whether
        if self._composed:
            self._follow_own()

    def _choose(self) -> None:
        topics = self.query_one(TopicsPanel)
        for topic in reversed(self.state.asked.topics):
            topics.follow(topic.name)
        topics.show_list()
        self.call_later(self._choose_service)

    def _drop_left(self) -> None:
        """Topics of a lesson that was left go once nobody publishes on them any more."""
        for name in [each for each in self._left if not self.state.is_published(each)]:
            self._left.discard(name)
            self.query_one(TopicsPanel).forget(name)

    def _follow_own(self) -> None:
        """Follow what a node of the learner's has begun to publish, each topic once: unfollowed, it stays so."""
        if not self._own_nodes or self.state.graph is None:
            return
        panel = self.query_one(TopicsPanel)
        for topic in self.state.graph.topics:
            name = topic.name
            if topic.is_standard or not topic.publishers or name in self._offered or len(self._offered) >= MOST_OFFERED:
                continue
            self._offered.add(name)
            if name not in self.state.topics:
                idle = not self.state.is_published(panel.chosen)
                panel.follow(name, show=idle and not panel.chosen_by_learner)

    async def _choose_service(self) -> None:
        panel = self.query_one(ServicesPanel)
        if panel.chosen_by_learner or self.state.graph is None:
            return
        for service in self.state.graph.services:
            if service.name in self.state.asked.services[:1] and service != panel.chosen:
                await panel.choose(service, focus=False)

    def focus_content(self) -> None:
        """Focus what the arrow keys move in; where there is nothing yet, as soon as there is."""
        if not self._composed:
            self._wants_focus = True
            return
        if self.has_class("-empty"):
            self.query_one(TabStrip).focus()
            return
        target = {"topics": "#topics-table", "parameters": "#parameters-table", "services": "#services-table"}
        self.query_one(target.get(self.query_one(TabStrip).active, "#graph-view")).focus()

    def open_tab(self, tab: str) -> None:
        """Show one of `TABS`."""
        self._wanted_tab = tab
        if self._composed:
            self.query_one(TabStrip).active = tab

    def action_step(self, by: int) -> None:
        """To the next tab, or the one before."""
        self.query_one(TabStrip).action_step(by)

    @on(TabStrip.Turned)
    def _turned(self, message: TabStrip.Turned) -> None:
        message.stop()
        self.query_one("#live-panels", ContentSwitcher).current = message.tab
        self.query_one(TabStrip).refresh()
        if self.has_focus_within and not self.query_one(TabStrip).has_focus:
            self.focus_content()

    # --- whether anyone looks ---

    def on_show(self, event: events.Show) -> None:
        """The page is turned to."""
        self._attend(True)
        if self._broken and self._command is not None:
            self.start_watching(self._command)

    def on_hide(self, event: events.Hide) -> None:
        """Another page is."""
        self._attend(False)

    def _attend(self, seen: bool) -> None:
        self._seen = seen
        self._send(SetVisible(seen))


def _answer_keys_sooner() -> None:
    """Keep Python's own affairs out of the way between a key and the screen, for as long as much is painted.

    What is there now is left out of garbage collections, each of which would go through all of it; what becomes garbage
    of it is found the next time that this is called. The thread that writes to the terminal need not wait for the one
    that paints for the default 5 ms.
    """
    gc.unfreeze()
    gc.collect()
    gc.freeze()
    sys.setswitchinterval(SWITCH_S)


def _advice(head: str, text: str) -> Content:
    return Content.assemble((head, "bold $foreground"), f"\n\n{text}" if text else "")
