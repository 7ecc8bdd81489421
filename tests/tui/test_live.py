"""The live page, driven by keyboard and mouse, with real nodes."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from itertools import pairwise

import pytest
from textual.color import Color

from tests.live.private_domain import METRONOME, THERMOMETER, LiveApp, PrivateDomain, private_domain
from tests.tui.person import Person
from tutor.content import load_course
from tutor.live.updates import TopicUpdate
from tutor.tui.live import services_panel
from tutor.tui.live.echo_view import EchoView
from tutor.tui.live.history import HistoryView
from tutor.tui.live.services_panel import ServicesPanel
from tutor.tui.live.state import TopicView
from tutor.tui.live.topics_panel import TopicsPanel


class Watcher(Person[LiveApp]):
    """Drives the live page."""

    limit_s = 30.0

    async def open_tab(self, tab: str) -> None:
        await self.pilot.click("#live-tabs", offset=(self.screen().splitlines()[0].index(tab) + 1, 0))
        await self.until(lambda: tab in self.bold_tab(), f"{tab} marked among the tabs")

    def bold_tab(self) -> str:
        """The bold text in the row of tabs, which marks the open one."""
        line = self.app.screen._compositor.render_strips()[0]
        return "".join(segment.text for segment in line if segment.style and segment.style.bold)

    def topics(self) -> TopicsPanel:
        return self.app.pane.query_one(TopicsPanel)

    def message_count(self) -> int:
        view = self.topics().view
        return view.update.count if view and view.update else 0


@pytest.fixture(scope="module")
def thermometer_world() -> Iterator[PrivateDomain]:
    """A domain with the thermometer on it."""
    with private_domain() as ros_world:
        ros_world.run(THERMOMETER, "10")
        yield ros_world


@pytest.fixture
def empty_world() -> Iterator[PrivateDomain]:
    """A domain with nothing on it."""
    with private_domain() as ros_world:
        yield ros_world


@asynccontextmanager
async def watching(ros_world: PrivateDomain, size: tuple[int, int] = (80, 20)) -> AsyncIterator[Watcher]:
    app = LiveApp(ros_world)
    async with app.run_test(size=size, notifications=True) as pilot:
        try:
            yield Watcher(app, pilot)
        finally:
            await app.pane.close_down()


async def test_the_cursor_shows_the_focus_and_enter_follows_a_topic_with_echo_statistics_and_plot(
    thermometer_world: PrivateDomain,
) -> None:
    async with watching(thermometer_world) as me:
        blurred, focused = (
            Color.parse(me.app.theme_variables[name]).rich_color.triplet
            for name in ("block-cursor-blurred-background", "block-cursor-background")
        )

        def cursor_color() -> object:
            line = next(strip for strip in me.app.screen._compositor.render_strips() if "/cmd_vel" in strip.text)
            segment = next(segment for segment in line if "/cmd_vel" in segment.text)
            return segment.style and segment.style.bgcolor and segment.style.bgcolor.triplet

        await me.sees("Topics 3", "/cmd_vel", "/sensor/temperature", "std_msgs/Float64", "1 node")
        await me.press("down")
        await me.until(lambda: cursor_color() == focused, "the list has the focus")
        await me.press("right_square_bracket")
        await me.sees("Allowed")
        await me.open_tab("Topics")  # the focus changes while the list is hidden
        await me.until(lambda: cursor_color() == blurred, "the tabs have the focus")
        await me.press("tab")
        await me.until(lambda: cursor_color() == focused, "the list has the focus again")

        await me.press("down")
        await me.sees("Not followed: press Enter")
        await me.press("enter")
        await me.sees("messages · ", "Hz · jitter", "data: 2", "---", "reliable, volatile", "10 s ago", "┤")
        braille = {chr(0x2800 + bits) for bits in range(1, 256)}
        await me.until(lambda: bool(braille.intersection(me.screen())), "a line in the plot")  # painted after the axis
        await me.press("delete")
        await me.sees("Not followed: press Enter")


async def test_a_paused_topic_freezes_its_view_and_keeps_counting_and_any_numeric_field_can_be_plotted(
    thermometer_world: PrivateDomain, monkeypatch: pytest.MonkeyPatch
) -> None:
    counts: list[int] = []
    receive = TopicView.receive

    def count_and_receive(view: TopicView, update: TopicUpdate, now: float) -> None:
        counts.append(update.count)
        receive(view, update, now)

    monkeypatch.setattr(TopicView, "receive", count_and_receive)
    async with watching(thermometer_world) as me:
        await me.sees("Topics 3", "/cmd_vel")  # all three: until then, the rows still move
        await me.pilot.click("#topics-table", offset=(5, 2))
        await me.until(lambda: me.topics().chosen == "/cmd_vel")
        await me.sees("Not followed", "Enter Follow")
        await me.pilot.click("#topics-table", offset=(5, 2))
        await me.sees("linear:", "angular:")
        await me.press("space")
        await me.sees("▮▮ paused", "Go on")
        before = me.message_count()
        await me.until(lambda: me.message_count() > before + 10)
        await me.pilot.click("#topic-actions", offset=(3, 0))
        await me.sees_no("paused")
        await me.press("C")
        await me.until(
            lambda: counts[-1] > 0 and any(after < former for former, after in pairwise(counts)), "counting restarts"
        )

        await me.sees("linear.x = ", "1 of 6")
        await me.press("y", "y")
        await me.sees("linear.z = 0", "3 of 6")
        await me.press("plus")
        await me.sees("30 s ago")
        await me.press("minus", "minus")
        await me.sees("5 s ago")


async def test_a_parameter_is_set_in_the_table_and_the_nodes_response_is_kept(thermometer_world: PrivateDomain) -> None:
    async with watching(thermometer_world) as me:
        await me.sees("Parameters 5")
        await me.open_tab("Parameters")
        await me.sees("publish_rate", "0.1 to 50", "read-only")
        me.app.pane.focus_content()
        await me.press("down", "down", "enter")
        await me.sees("Set /thermometer publish_rate (double)")
        await me.press(*"fast", "enter")
        await me.sees("✗ Write a number")
        await me.press("home", *["delete"] * 4, *"25", "enter")
        await me.sees("/thermometer publish_rate = 25.0  accepted")
        await me.press("enter", *"99", "enter")
        await me.sees("publish_rate = 99.0  rejected", "range")
        await me.press("down", "enter", "delete", "enter")
        await me.sees("sensor_name = ''  rejected", "sensor_name must not be empty", "accepted")
        await me.press("down", "enter")
        await me.sees("serial is read-only")


async def test_another_lesson_begins_without_the_parameters_and_outcomes_of_the_last(
    thermometer_world: PrivateDomain,
) -> None:
    course = load_course()
    first, second = course.find("i1.1"), course.find("i1.2")
    async with watching(thermometer_world, (100, 24)) as me:
        me.app.pane.set_lesson(first)
        await me.sees("Parameters 5")
        await me.open_tab("Parameters")
        me.app.pane.focus_content()
        await me.press("down", "down", "enter", "ctrl+u", *"99", "enter")
        await me.sees("publish_rate = 99.0  rejected")
        me.app.pane.set_lesson(second)
        await me.sees_no("publish_rate")
        await me.sees("From another exercise: /thermometer. u lists their parameters, too.")
        await me.sees_no("Parameters 5")
        await me.press("u")
        await me.sees("/thermometer", "0.1 to 50")
        await me.sees_no("From another exercise")
        await me.press("u")
        me.app.pane.set_lesson(first)
        await me.sees("Parameters 5", "0.1 to 50")


async def test_the_lessons_topic_and_service_are_selected_and_a_call_by_form_shows_the_response_and_its_time(
    thermometer_world: PrivateDomain,
) -> None:
    async with watching(thermometer_world) as me:

        def calls_parameter() -> object:
            return {each.name: each.value for each in me.app.pane.state.listed_parameters()}["calls"]

        me.app.pane.set_lesson(load_course().find("i1.1"))
        await me.sees("/sensor/temperature", "data: 2")
        await me.open_tab("Parameters")
        await me.sees("calls")
        before = calls_parameter()
        assert isinstance(before, int)
        me.app.pane.set_lesson(load_course().find("i1.3"))
        await me.open_tab("Services")
        await me.sees("/add  example_interfaces/AddTwoInts", "a int64", "b int64")
        me.app.pane.focus_content()
        await me.press("enter")
        await me.press(*"4.5", "enter")
        await me.sees("✗ Write a whole number")
        await me.press("backspace", "backspace", "tab", *"38", "enter")
        await me.sees("✓", "/add a=4, b=38", "answered in", "sum: 42")
        await me.open_tab("Parameters")  # the node has changed one itself
        await me.until(lambda: calls_parameter() == before + 1)
        me.app.pane.focus_content()
        await me.press("u")  # the node is from another exercise
        await me.sees("calls")


async def test_a_slow_call_blocks_nothing_and_can_be_cancelled_or_times_out(
    thermometer_world: PrivateDomain, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with watching(thermometer_world) as me:
        await me.sees("Services 2")
        await me.open_tab("Services")
        me.app.pane.focus_content()
        await me.press("down", "enter")
        await me.sees("/slow_add  example", "a int64")
        await me.press("enter")
        await me.sees("/slow_add  waiting")
        await me.open_tab("Topics")
        await me.sees("/cmd_vel")
        await me.open_tab("Services")
        me.app.pane.focus_content()
        await me.press("escape")
        await me.sees("■", "cancelled after")

        monkeypatch.setattr(services_panel, "CALL_TIMEOUT_S", 0.5)
        panel = me.app.pane.query_one(ServicesPanel)
        panel.action_call()
        await me.until(lambda: "no answer within 0.5 s: does the node spin" in panel.query_one(HistoryView).plain)


async def test_the_graph_explains_why_two_nodes_are_not_connected_in_any_size(thermometer_world: PrivateDomain) -> None:
    async with watching(thermometer_world) as me:
        await me.sees("Graph ✗ 1")
        await me.open_tab("Graph")
        await me.sees("──✗", "not connected", "reliability best_effort", "──▶")
        await me.pilot.resize_terminal(120, 40)
        await me.sees("──✗", "not connected", "reliability best_effort", "──▶")


async def test_on_an_empty_domain_a_node_comes_with_its_plot_and_goes_with_the_topics_of_a_previous_lesson(
    empty_world: PrivateDomain,
) -> None:
    async with watching(empty_world, (120, 30)) as me:
        await me.sees(f"No node runs in domain {empty_world.domain}: press r to run yours")
        me.app.pane.set_lesson(load_course().find("i1.1"))
        node = await asyncio.to_thread(empty_world.run, THERMOMETER, "2")
        await me.sees("data: 2", "1 node")
        await me.sees("asked: 20 to 30", "•", "╌╌╌", "30┤", "20┤")  # samples and the required range
        me.app.pane.set_lesson(load_course().find("i1.2"))
        await me.until(lambda: me.topics().chosen == "/chatter")
        await me.sees("/sensor/temperature", "data: warm", "Hz · jitter")
        await asyncio.to_thread(empty_world.interrupt, node)
        await me.sees_no("/sensor/temperature")
        await me.sees("No node runs in domain", "/chatter", "silent for", "0 nodes")


async def test_messages_received_while_another_tab_is_open_are_counted_and_kept_to_scroll_back_to(
    empty_world: PrivateDomain,
) -> None:
    count = 20
    async with watching(empty_world) as me:
        await me.sees("No node runs")
        me.topics().follow("/ticks")
        await asyncio.to_thread(empty_world.run, METRONOME, "4", str(count))
        await me.sees("/ticks", " messages · ")
        await me.press("right_square_bracket")
        await me.sees("Allowed")
        await me.until(lambda: me.message_count() == count, "all have arrived")
        await me.press("left_square_bracket")
        await me.sees(f"{count} messages · ")
        await me.until(lambda: any("/ticks" in line and f" {count} " in line for line in me.screen().splitlines()))

        echo = me.topics().query_one(EchoView)
        await me.until(lambda: echo.plain.count("---") >= count - 2, "all are kept")
        await me.until(lambda: echo.is_vertical_scroll_end, "the newest is shown")
        echo.focus()
        await me.press("home")
        await me.until(lambda: echo.scroll_offset.y == 0)
        assert "data: 0" in echo.plain
        await me.press("end")
        await me.until(lambda: echo.is_vertical_scroll_end)


async def test_my_nodes_topic_is_followed_automatically_but_not_once_it_was_unfollowed(
    empty_world: PrivateDomain,
) -> None:
    async with watching(empty_world) as me:
        await me.sees("No node runs")
        me.app.pane.set_lesson(load_course().find("i1.1"))
        me.app.pane.set_own_nodes_running(True)
        await asyncio.to_thread(empty_world.run, METRONOME, "5", "1000")
        await me.sees("/ticks  std_msgs/", "messages · ", "Hz")
        await me.press("delete")
        await me.sees("Not followed: press Enter")
        await asyncio.to_thread(empty_world.run, THERMOMETER, "5")
        await me.sees("/cmd_vel")
        assert "/ticks" not in me.app.pane.state.topics
        assert "/sensor/temperature" in me.app.pane.state.topics


async def test_a_misspelled_topic_name_is_reported_with_its_node(empty_world: PrivateDomain) -> None:
    async with watching(empty_world, (120, 24)) as me:
        await me.sees("No node runs")
        me.app.pane.set_lesson(load_course().find("i1.1"))
        misspelling = ("--ros-args", "-r", "/sensor/temperature:=/sensor/temprature")
        node = await asyncio.to_thread(empty_world.run, THERMOMETER, "5", *misspelling)
        await me.sees("/thermometer publishes /sensor/temprature; the exercise asks for /sensor/temperature. Did you")
        me.app.pane.set_lesson(load_course().find("i1.3"))
        await me.sees_no("Did you mean")
        me.app.pane.set_lesson(load_course().find("i1.1"))
        await me.sees("Did you mean")
        await asyncio.to_thread(empty_world.interrupt, node)
        await me.sees_no("Did you mean")


async def test_a_dead_watcher_is_reported_and_can_be_restarted(empty_world: PrivateDomain) -> None:
    async with watching(empty_world) as me:
        await me.sees("No node runs")
        child = me.app.pane._watcher.child
        assert child is not None
        child.kill()
        await me.sees("Nothing is watched", "! not watching")
        await me.until(lambda: bool(me.app.errors), "a toast")
        me.app.pane.start_watching(empty_world.command)
        await me.sees("No node runs")


async def test_the_app_quits_at_once_and_leaves_no_watcher_process(empty_world: PrivateDomain) -> None:
    app = LiveApp(empty_world)
    async with app.run_test() as pilot:
        while app.pane._watcher.child is None:
            await pilot.pause(0.02)
        process = app.pane._watcher.child._process
    async with asyncio.timeout(5):
        await process.wait()
