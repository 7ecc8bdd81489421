"""The live page: what the nodes on the user's own domain are really doing."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import ContentSwitcher, Static
from textual.worker import Worker

from tutor.content import Lesson
from tutor.live.protocol import Follow, Publish, StopPublishing, Unfollow, Update, WatcherError
from tutor.live.updates import CallOutcome, NodeParameters, PublishStatus, RequestForm, SetOutcome, TopicUpdate
from tutor.ros_model import Graph
from tutor.tui import messages
from tutor.tui.key_latency import reduce_key_latency
from tutor.tui.live.automatic_topics import AutomaticTopics
from tutor.tui.live.graph_panel import GraphPanel
from tutor.tui.live.parameters_panel import ParametersPanel
from tutor.tui.live.publish_dialog import PublishScreen
from tutor.tui.live.publishing import Publishing
from tutor.tui.live.services_panel import ServicesPanel
from tutor.tui.live.state import LiveState
from tutor.tui.live.status import TABS, empty_text, near_miss_text, status_line, tab_labels
from tutor.tui.live.topics_panel import TopicsPanel, WatcherRequested
from tutor.tui.live.watcher import Watcher, WatcherCommand
from tutor.tui.widgets.steady_static import SteadyStatic
from tutor.tui.widgets.strip import TabStrip


class LivePane(Vertical):
    """Topics, parameters, services and the graph, fed from real DDS by a child process.

    It costs nothing until `start_watching(command)` is called, when the page is first opened or a node of the learner's
    runs; `command` is called in a thread. The child process also ends when the pane is unmounted or the app is killed.

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
        self._watcher = Watcher(self.state, self._forward, self._show_end)
        self._automatic = AutomaticTopics(self.state)
        self._publishing = Publishing(self.state, id="live-publishing")
        self._worker: Worker[None] | None = None
        self._command: Callable[[], WatcherCommand] | None = None
        self._restart_with: Callable[[], WatcherCommand] | None = None
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
        yield self._publishing
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
            self._command, self._watcher.failure = command, ""
            reduce_key_latency()
            watch: Callable[[], Any] = partial(self._watcher.run, command)
            self._worker = self.run_worker(watch, group="live", exit_on_error=False)
            if self._composed:
                self._show_status()

    def stop_watching(self) -> None:
        """Stop the watcher process. Returns at once; the process is certain to end, within two seconds."""
        if self._worker is not None:
            self._worker.cancel()

    def restart_watching(self) -> None:
        """Start the watcher process again, if it is running: a process knows only the types that it started with."""
        if self._worker is not None and self._command is not None:
            self._restart_with = self._command
            self.stop_watching()

    async def close_down(self) -> None:
        """Stop the watcher process, and wait until it is gone."""
        if (child := self._watcher.child) is not None:
            self.stop_watching()
            await child.stop()

    async def on_unmount(self) -> None:
        """Stop the watcher process with the pane."""
        await self.close_down()

    def _forward(self, update: Update) -> None:
        self.post_message(self.Arrived(update))

    def _show_end(self) -> None:
        self._worker = None
        if self.is_attached and (command := self._restart_with) is not None:
            self._restart_with = None
            self.call_later(self.start_watching, command)
        if self.is_attached:
            self._show_all()
            if failure := self._watcher.failure:
                self.post_message(messages.ErrorOccurred(f"The live page has stopped watching: {failure}"))

    @on(WatcherRequested)
    def _send_requested(self, message: WatcherRequested) -> None:
        message.stop()
        self._watcher.send(message.command)
        if isinstance(message.command, Follow | Unfollow):
            self._show_status()

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
                self._automatic.unfollow_stale_topics(self.query_one(TopicsPanel))
                self._automatic.follow_own_topics(self.query_one(TopicsPanel))
                self._show_all()
                await self.query_one(ServicesPanel).choose_lesson_service()
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
                self._publishing.show()
            case WatcherError(text):
                self.post_message(messages.ErrorOccurred(text))
            case _:
                self._show_status()

    def _show_all(self) -> None:
        self.query_one(TopicsPanel).show_list()
        self.query_one(ParametersPanel).show_list()
        self.query_one(ParametersPanel).show_history()
        self.query_one(ServicesPanel).show_list()
        self.query_one(ServicesPanel).show_history()
        self.query_one(GraphPanel).show_list()
        self._publishing.show()
        self._show_status()

    def _show_status(self) -> None:
        """Show the counts on the tabs, what is watched, and what to do if there is nothing to see."""
        state, watching, failure = self.state, self._worker is not None, self._watcher.failure
        self.query_one(TabStrip).labels = tab_labels(state)
        self.query_one("#live-status", Static).update(status_line(state, watching, failure))
        has_messages = any(view.update is not None and view.update.count for view in state.topics.values())
        text = empty_text(state, watching, failure, short=has_messages)
        was_empty = self.has_class("-empty")
        self.set_class(bool(text) and not has_messages, "-empty")
        if was_empty and not self.has_class("-empty") and self.query_one(TabStrip).has_focus:
            self.focus_content()  # until now, only the tabs could have the focus
        self.set_class(bool(text) and has_messages, "-note")
        misses = near_miss_text(state)
        self.set_class(bool(misses), "-miss")
        self.query_one("#live-miss", Static).update(misses)
        self.query_one("#live-empty" if not has_messages else "#live-note", Static).update(text)

    # --- publishing by hand ---

    def publish(self) -> None:
        """Stop publishing at a rate, on the shown topic first; if nothing is being published, ask what to publish."""
        topic = self.query_one(TopicsPanel).chosen if self._composed else ""
        if active := self._publishing.active:
            self._watcher.send(StopPublishing(topic if topic in active else active[0]))
            return

        def answered(request: Publish | None) -> None:
            if request is not None:
                panel = self.query_one(TopicsPanel)
                panel.follow(request.topic)
                panel.post_message(WatcherRequested(request))  # posted after the request to follow

        self.app.push_screen(PublishScreen(topic, self.state.type_of, self._watcher.send), answered)

    # --- selection ---

    def set_lesson(self, lesson: Lesson) -> None:
        """Choose this lesson's topics and service as soon as they appear, unless the learner has chosen others.

        Topics of the previous lesson go once they have no publisher; its parameters, sets and calls at once.
        """
        if lesson.live is self.state.lesson_view:
            return
        self._automatic.set_lesson(lesson.live)
        if self._composed:
            self._automatic.unfollow_stale_topics(self.query_one(TopicsPanel))
            self.query_one(TopicsPanel).chosen_by_learner = False
            self.query_one(ServicesPanel).chosen_by_learner = False
            self._choose_lesson_topics()
            self._show_all()

    def set_own_nodes_running(self, running: bool) -> None:
        """Note whether any of the learner's own nodes is running.

        While any is, newly published topics are followed, and shown if the shown topic has no publisher.
        """
        self._automatic.own_nodes_running = running
        if self._composed:
            self._automatic.follow_own_topics(self.query_one(TopicsPanel))

    def _choose_lesson_topics(self) -> None:
        self._automatic.follow_lesson_topics(self.query_one(TopicsPanel))
        self.call_later(self.query_one(ServicesPanel).choose_lesson_service)

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
        self._watcher.set_page_visible(True)
        if self._watcher.failure and self._command is not None:
            self.start_watching(self._command)

    def on_hide(self, event: events.Hide) -> None:
        """Report that the page is hidden."""
        self._watcher.set_page_visible(False)
