"""The live page: what the nodes on the user's own domain are really doing."""

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
from tutor.live.protocol import (
    Follow,
    Plot,
    Publish,
    SetVisible,
    StopPublishing,
    Unfollow,
    Update,
    WatcherError,
    WatcherRequest,
)
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

_MAX_NEAR_MISSES = 3
"""At most this many near misses of names are shown at once."""

_MAX_AUTO_FOLLOWED = 8
"""At most this many topics of the learner's own nodes are followed automatically."""

_SWITCH_INTERVAL_S = 0.0005
"""Python's thread switch interval for the app, in seconds."""

TABS = {"topics": "Topics", "parameters": "Parameters", "services": "Services", "graph": "Graph"}


class LivePane(Vertical):
    """Topics, parameters, services and the graph, fed from real DDS by a child process.

    Mount `LivePane(id="live")` anywhere; it costs nothing until it watches. The screen that contains it calls

    - `start_watching(command)` when the page is first opened, or a node of the learner's runs. Returns at once; does
      nothing if it is watching already. `command` is called in a worker thread.
    - `stop_watching()` to stop; returns at once, and the child is certain to end. `await close_down()` does the same
      and waits (well under two seconds). The child also ends when the pane is unmounted or the app is killed.
    - `set_lesson(lesson)` when another lesson is shown: its topic, node and service are chosen as soon as they appear,
      unless the learner has chosen others; topics of the previous lesson go once they have no publisher.
    - `set_own_nodes_running(running)` when the first of the learner's nodes starts, and when the last one ends: while
      any runs, newly published topics are followed, and shown if the shown topic has no publisher.
    - `open_tab(tab)` to show one of `TABS`.
    - `focus_content()` to focus the widget that the arrow keys are useful in.

    It posts `tutor.tui.messages.ErrorOccurred`, which bubbles up to the screen for a toast. Its keys: [ and ] turn its
    tabs, Enter chooses, Space pauses, and x, y, u, + and -: each panel shows the available ones on its last line. Other
    keys of the screen keep working, except in the inputs of its forms.
    """

    DEFAULT_CSS = Path(__file__).with_name("pane.tcss").read_text("utf-8")
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left_square_bracket", "step(-1)", "Previous tab", show=False),
        Binding("right_square_bracket", "step(1)", "Next tab", show=False),
    ]

    class Arrived(Message):
        """The watcher process has sent an update."""

        def __init__(self, update: Update) -> None:
            super().__init__()
            self.update = update

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.state = LiveState()
        self._child: LiveChild | None = None
        self._worker: Worker[None] | None = None
        self._command: Callable[[], WatcherCommand] | None = None
        self._failure = ""
        self._stale_topics: set[str] = set()
        self._own_nodes_running = False
        self._auto_followed: set[str] = set()
        self._page_visible = False
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
        self._choose_lesson_topics()
        if self._wanted_tab:
            self.open_tab(self._wanted_tab)
        if self._wants_focus:
            self.focus_content()

    # --- the watcher process ---

    def start_watching(self, command: Callable[[], WatcherCommand]) -> None:
        """Start the watcher process, unless it is running."""
        if self._worker is None:
            self._command, self._failure = command, ""
            _reduce_key_latency()
            watch: Callable[[], Any] = partial(self._watch, command)
            self._worker = self.run_worker(watch, group="live", exit_on_error=False)
            if self._composed:
                self._show_status()

    def stop_watching(self) -> None:
        """Stop the watcher process without waiting."""
        if self._worker is not None:
            self._worker.cancel()

    async def close_down(self) -> None:
        """Stop the watcher process, and wait until it is gone."""
        if (child := self._child) is not None:
            self.stop_watching()
            await child.stop()

    async def on_unmount(self) -> None:
        """Stop the watcher process with the pane."""
        await self.close_down()

    async def _watch(self, command: Callable[[], WatcherCommand]) -> None:
        child: LiveChild | None = None
        failure = "ended by itself"
        try:
            found = await asyncio.to_thread(command)
            self.state.domain = found.domain
            self._child = child = await LiveChild.start(found)
            child.send(SetVisible(self._page_visible))
            for view in self.state.topics.values():
                child.send(Follow(view.topic))
                if view.path:
                    child.send(Plot(view.topic, view.path))
            async for update in child.updates():
                self.post_message(self.Arrived(update))
            failure = child.last_error_line or failure
        except asyncio.CancelledError:
            failure = ""
            raise
        except (OSError, ValueError) as error:
            failure = str(error)
        finally:
            if child is not None:
                child.detach()
            self._child = self._worker = None
            self.state.reset_domain()
            if self.is_attached:
                self._failure = failure
                self._show_all()
                if failure:
                    self.post_message(messages.ErrorOccurred(f"The live page has stopped watching: {failure}"))
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

    # --- updates ---

    @on(Arrived)
    async def _arrived(self, message: Arrived) -> None:
        message.stop()
        update = message.update
        self.state.receive(update)
        match update:
            case TopicUpdate(topic):
                self.query_one(TopicsPanel).show_update(topic)
            case Graph():
                self._unfollow_stale_topics()
                self._follow_own_topics()
                self._show_all()
                await self._choose_lesson_service()
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
            case WatcherError(text):
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
        """Show the counts on the tabs, what is watched, and what to do if there is nothing to see."""
        state = self.state
        graph = state.graph or Graph()
        counts = {
            "topics": sum(not topic.is_standard for topic in graph.topics),
            "parameters": len(state.listed_parameters(include_standard=False)),
            "services": sum(not service.is_standard for service in graph.services),
            "graph": 0,
        }
        labels = {name: f"{label} {counts[name]}" if counts[name] else label for name, label in TABS.items()}
        if broken := len(state.mismatches()):
            labels["graph"] = f"Graph ✗ {broken}"
        self.query_one(TabStrip).labels = labels
        nodes = len(state.nodes)
        domain = f"domain {state.domain}"
        status = f"● {nodes} node{'' if nodes == 1 else 's'} · {domain}" if state.ready else "◐ starting"
        if self._worker is None:
            status = "! not watching" if self._failure else "not watching"
        self.query_one("#live-status", Static).update(status)
        has_messages = any(view.update is not None and view.update.count for view in state.topics.values())
        text = self._empty_text(short=has_messages)
        was_empty = self.has_class("-empty")
        self.set_class(bool(text) and not has_messages, "-empty")
        if was_empty and not self.has_class("-empty") and self.query_one(TabStrip).has_focus:
            self.focus_content()  # until now, only the tabs could have the focus
        self.set_class(bool(text) and has_messages, "-note")
        misses = [str(miss) for miss in near_misses(graph, state.lesson_view)]
        self.set_class(bool(misses), "-miss")
        self.query_one("#live-miss", Static).update("\n".join(f"≈ {miss}" for miss in misses[:_MAX_NEAR_MISSES]))
        self.query_one("#live-empty" if not has_messages else "#live-note", Static).update(text)

    def _empty_text(self, short: bool) -> Content:
        """Return why there is nothing to see and what to do about it; empty if any node runs."""
        domain = self.state.domain
        if self._failure:
            return _advice("Nothing is watched", f"{self._failure}\nTurn to another page and back to watch again.")
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
            " to run yours." if short else " to run yours.\nTopics, parameters, services and the graph appear here.",
        )

    # --- publishing by hand ---

    def publish(self) -> None:
        """Stop publishing at a rate, on the shown topic first; if nothing is being published, ask what to publish."""
        topic = self.query_one(TopicsPanel).chosen if self._composed else ""
        active = [held.topic for held in self.state.published.values() if held.rate_hz and not held.over]
        if active:
            self._send(StopPublishing(topic if topic in active else active[0]))
            return

        def answered(request: Publish | None) -> None:
            if request is not None:
                panel = self.query_one(TopicsPanel)
                panel.follow(request.topic)
                panel.post_message(WatcherRequested(request))  # posted after the request to follow

        self.app.push_screen(PublishScreen(topic, self._type_of, self._send), answered)

    def _type_of(self, topic: str) -> str:
        found = self.state.graph.topic(topic) if self.state.graph else None
        lesson_types = (known.type for known in self.state.lesson_view.topics if known.name == topic)
        return found.types[0] if found is not None else next(lesson_types, "")

    def _show_publishing(self) -> None:
        text = "\n".join(wording.publishing(held) for held in self.state.published.values())
        self.set_class(bool(text), "-publishing")
        self.query_one("#live-publishing", Static).update(text)

    # --- selection ---

    def set_lesson(self, lesson: Lesson) -> None:
        """Choose this lesson's topics and service as soon as they appear."""
        if lesson.live is self.state.lesson_view:
            return
        self.state.lesson_view = lesson.live
        self._stale_topics = {name for name in self.state.topics if not self.state.is_lesson_topic(name)}
        self._auto_followed.clear()
        if self._composed:
            self._unfollow_stale_topics()
            self.query_one(TopicsPanel).chosen_by_learner = False
            self.query_one(ServicesPanel).chosen_by_learner = False
            self._choose_lesson_topics()
            self._show_status()

    def set_own_nodes_running(self, running: bool) -> None:
        """Note whether any of the learner's own nodes is running."""
        self._own_nodes_running = running
        if self._composed:
            self._follow_own_topics()

    def _choose_lesson_topics(self) -> None:
        topics = self.query_one(TopicsPanel)
        for topic in reversed(self.state.lesson_view.topics):
            topics.follow(topic.name)
        topics.show_list()
        self.call_later(self._choose_lesson_service)

    def _unfollow_stale_topics(self) -> None:
        """Unfollow topics of earlier lessons that no longer have a publisher."""
        for name in [each for each in self._stale_topics if not self.state.is_published(each)]:
            self._stale_topics.discard(name)
            self.query_one(TopicsPanel).unfollow(name)

    def _follow_own_topics(self) -> None:
        """Follow new topics while a node of the learner's runs, each only once: if unfollowed, it stays unfollowed."""
        if not self._own_nodes_running or self.state.graph is None:
            return
        panel = self.query_one(TopicsPanel)
        for topic in self.state.graph.topics:
            name = topic.name
            if (
                topic.is_standard
                or not topic.publishers
                or name in self._auto_followed
                or len(self._auto_followed) >= _MAX_AUTO_FOLLOWED
            ):
                continue
            self._auto_followed.add(name)
            if name not in self.state.topics:
                idle = not self.state.is_published(panel.chosen)
                panel.follow(name, show=idle and not panel.chosen_by_learner)

    async def _choose_lesson_service(self) -> None:
        panel = self.query_one(ServicesPanel)
        if panel.chosen_by_learner or self.state.graph is None:
            return
        for service in self.state.graph.services:
            if service.name in self.state.lesson_view.services[:1] and service != panel.chosen:
                await panel.choose(service, focus=False)

    def focus_content(self) -> None:
        """Focus the widget that the arrow keys move in, as soon as there is one."""
        if not self._composed:
            self._wants_focus = True
            return
        if self.has_class("-empty"):
            self.query_one(TabStrip).focus()
            return
        target = {"topics": "#topics-table", "parameters": "#parameters-table", "services": "#services-table"}
        self.query_one(target.get(self.query_one(TabStrip).active, "#graph-view")).focus()

    def open_tab(self, tab: str) -> None:
        """Show one of `TABS`, as soon as the pane is composed."""
        self._wanted_tab = tab
        if self._composed:
            self.query_one(TabStrip).active = tab

    def action_step(self, by: int) -> None:
        """Turn to the next tab, or with a negative `by` to the previous one."""
        self.query_one(TabStrip).action_step(by)

    @on(TabStrip.Turned)
    def _turned(self, message: TabStrip.Turned) -> None:
        message.stop()
        self.query_one("#live-panels", ContentSwitcher).current = message.tab
        self.query_one(TabStrip).refresh()
        if self.has_focus_within and not self.query_one(TabStrip).has_focus:
            self.focus_content()

    # --- visibility ---

    def on_show(self, event: events.Show) -> None:
        """Report that the page is visible; watch again if the watcher process had failed."""
        self._set_page_visible(True)
        if self._failure and self._command is not None:
            self.start_watching(self._command)

    def on_hide(self, event: events.Hide) -> None:
        """Report that the page is hidden."""
        self._set_page_visible(False)

    def _set_page_visible(self, visible: bool) -> None:
        self._page_visible = visible
        self._send(SetVisible(visible))


def _reduce_key_latency() -> None:
    """Keep the interpreter from delaying key presses while much is being painted.

    Objects alive now are excluded from garbage collection, which would scan them all each time; those that become
    garbage are collected at the next call. A short switch interval lets the thread that writes to the terminal run
    without waiting for the painting thread for the default 5 ms.
    """
    gc.unfreeze()
    gc.collect()
    gc.freeze()
    sys.setswitchinterval(_SWITCH_INTERVAL_S)


def _advice(head: str, text: str) -> Content:
    return Content.assemble((head, "bold $foreground"), f"\n\n{text}" if text else "")
