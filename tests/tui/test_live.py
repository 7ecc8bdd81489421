"""The live page, by key and mouse, on real nodes."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from itertools import pairwise

import pytest
from textual.color import Color
from textual.pilot import Pilot

from tests.live.world import METRONOME, THERMOMETER, LiveApp, World, world
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
    """Somebody in front of the live page."""

    limit_s = 30.0

    def __init__(self, app: LiveApp, pilot: Pilot[int], around: World) -> None:
        super().__init__(app, pilot)
        self.around = around

    async def open_tab(self, tab: str) -> None:
        await self.pilot.click("#live-tabs", offset=(self.screen().splitlines()[0].index(tab) + 1, 0))
        await self.until(lambda: tab in self.marked(), f"{tab} marked among the tabs")

    def marked(self) -> str:
        """What is written in bold in the line of the tabs."""
        line = self.app.screen._compositor.render_strips()[0]
        return "".join(segment.text for segment in line if segment.style and segment.style.bold)

    def topics(self) -> TopicsPanel:
        return self.app.pane.query_one(TopicsPanel)

    def count(self) -> int:
        view = self.topics().view
        return view.update.count if view and view.update else 0


@pytest.fixture(scope="module")
def warm() -> Iterator[World]:
    """A domain with the thermometer on it."""
    with world() as around:
        around.run(THERMOMETER)
        yield around


@pytest.fixture
def cold() -> Iterator[World]:
    """A domain with nothing on it."""
    with world() as around:
        yield around


@asynccontextmanager
async def watching(around: World, size: tuple[int, int] = (80, 20)) -> AsyncIterator[Watcher]:
    app = LiveApp(around)
    async with app.run_test(size=size, notifications=True) as pilot:
        try:
            yield Watcher(app, pilot, around)
        finally:
            await app.pane.close_down()


async def test_a_topic_is_followed_with_enter_and_shown_as_echo_writes_it_with_numbers_and_a_plot(warm: World) -> None:
    async with watching(warm) as me:
        await me.sees("Topics 3", "/sensor/temperature", "std_msgs/Float64", "1 node")
        await me.press("down", "down")
        await me.sees("Not followed: press Enter")
        await me.press("enter")
        await me.sees("messages · ", "Hz · jitter", "data: 2", "---", "reliable, volatile", "10 s ago", "┤")
        assert set(me.screen()) & {chr(0x2800 + bits) for bits in range(1, 256)}, "a line is drawn"
        await me.press("delete")
        await me.sees("Not followed: press Enter")


async def test_a_paused_topic_stands_still_and_is_counted_all_the_same(
    warm: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    counts: list[int] = []
    hear = TopicView.receive

    def heard(view: TopicView, update: TopicUpdate, now: float) -> None:
        counts.append(update.count)
        hear(view, update, now)

    monkeypatch.setattr(TopicView, "receive", heard)
    async with watching(warm) as me:
        await me.sees("Topics 3", "/cmd_vel")  # all three: else the rows still move
        await me.pilot.click("#topics-table", offset=(5, 2))
        await me.until(lambda: me.topics().chosen == "/cmd_vel")
        await me.sees("Not followed", "Enter Follow")
        await me.pilot.click("#topics-table", offset=(5, 2))
        await me.sees("linear:", "angular:")
        await me.press("space")
        await me.sees("▮▮ paused", "Go on")
        before = me.count()
        await me.until(lambda: me.count() > before + 10)
        await me.pilot.click("#topic-actions", offset=(3, 0))
        await me.sees_no("paused")
        await me.press("x")
        await me.until(lambda: counts[-1] > 0 and any(after < former for former, after in pairwise(counts)), "again")


async def test_what_comes_while_another_tab_is_open_is_in_the_list_when_i_am_back(cold: World) -> None:
    async with watching(cold) as me:
        await me.sees("No node runs")
        me.topics().follow("/ticks")
        cold.run(METRONOME, "100", "300")
        await me.sees("/ticks", " messages · ")
        await me.press("right_square_bracket")
        await me.sees("Allowed")
        await me.until(lambda: me.count() == 300, "all have come")
        await me.press("left_square_bracket")
        await me.sees("300 messages · ")
        await me.until(lambda: any("/ticks" in line and " 300 " in line for line in me.screen().splitlines()))


async def test_the_cursor_of_a_list_shows_whether_the_keys_go_to_it_also_when_that_changed_unseen(warm: World) -> None:
    async with watching(warm) as me:
        blurred, focused = (
            Color.parse(me.app.theme_variables[name]).rich_color.triplet
            for name in ("block-cursor-blurred-background", "block-cursor-background")
        )

        def cursor() -> object:
            line = next(strip for strip in me.app.screen._compositor.render_strips() if "/cmd_vel" in strip.text)
            segment = next(segment for segment in line if "/cmd_vel" in segment.text)
            return segment.style and segment.style.bgcolor and segment.style.bgcolor.triplet

        await me.sees("Topics 3", "/cmd_vel")
        await me.press("down")
        await me.until(lambda: cursor() == focused, "the list has the focus")
        await me.press("right_square_bracket")
        await me.sees("Allowed")
        await me.open_tab("Topics")
        await me.until(lambda: cursor() == blurred, "the tabs have it")
        await me.press("tab")
        await me.until(lambda: cursor() == focused, "the list has it again")


async def test_any_numeric_field_can_be_plotted(warm: World) -> None:
    async with watching(warm) as me:
        await me.sees("/cmd_vel")
        me.topics().follow("/cmd_vel")
        await me.sees("linear.x = ", "1 of 6")
        await me.press("y", "y")
        await me.sees("linear.z = 0", "3 of 6")
        await me.press("plus")
        await me.sees("30 s ago")
        await me.press("minus", "minus")
        await me.sees("5 s ago")


async def test_the_lessons_topic_and_service_are_chosen_by_themselves(warm: World) -> None:
    async with watching(warm) as me:
        me.app.pane.show_for(load_course().find("i1.1"))
        await me.sees("/sensor/temperature", "data: 2")
        me.app.pane.show_for(load_course().find("i1.3"))
        await me.open_tab("Services")
        await me.sees("/add  example_interfaces/AddTwoInts", "a int64", "b int64")


async def test_a_parameter_is_set_in_the_table_and_what_the_node_says_is_kept(warm: World) -> None:
    async with watching(warm) as me:
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


async def test_a_parameter_that_the_node_changes_itself_is_shown_again(warm: World) -> None:
    async with watching(warm) as me:
        await me.sees("Services 2")
        await me.open_tab("Parameters")
        await me.sees("calls")
        held = {each.name: each.value for each in me.app.pane.state.listed_parameters()}
        await me.open_tab("Services")
        me.app.pane.focus_content()
        await me.press("enter")
        await me.sees("a int64")
        await me.press("enter")
        await me.sees("sum: 0")
        await me.open_tab("Parameters")
        await me.until(
            lambda: {e.name: e.value for e in me.app.pane.state.listed_parameters()}["calls"] == held["calls"] + 1
        )
        await me.sees("calls")


async def test_a_service_is_called_by_its_form_and_the_answer_has_its_time(warm: World) -> None:
    async with watching(warm) as me:
        await me.sees("Services 2")
        await me.open_tab("Services")
        me.app.pane.focus_content()
        await me.press("enter")
        await me.sees("a int64", "b int64")
        await me.press(*"4.5", "enter")
        await me.sees("✗ Write a whole number")
        await me.press("backspace", "backspace", "tab", *"38", "enter")
        await me.sees("✓", "/add a=4, b=38", "answered in", "sum: 42")


async def test_a_slow_call_holds_nothing_up_and_can_be_cancelled(warm: World) -> None:
    async with watching(warm) as me:
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


async def test_a_call_without_an_answer_says_so(warm: World, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(services_panel, "LIMIT_S", 0.5)
    async with watching(warm) as me:
        await me.sees("Services 2")
        panel = me.app.pane.query_one(ServicesPanel)
        await me.open_tab("Services")
        await panel.choose(next(each for each in panel._listed if each.name == "/slow_add"))
        await me.sees("a int64")
        panel.action_call()
        await me.until(lambda: "no answer within 0.5 s: does the node spin" in panel.query_one(HistoryView).plain)


@pytest.mark.parametrize("size", [(80, 20), (120, 40)])
async def test_the_graph_says_in_words_why_two_are_not_connected(warm: World, size: tuple[int, int]) -> None:
    async with watching(warm, size) as me:
        await me.sees("Graph ✗ 1")
        await me.open_tab("Graph")
        await me.sees("──✗", "not connected", "reliability best_effort", "──▶")


async def test_where_nothing_runs_the_page_says_what_to_do_and_nodes_come_and_go(cold: World) -> None:
    async with watching(cold) as me:
        await me.sees(f"No node runs in domain {cold.domain}: press r to run yours")
        me.app.pane.show_for(load_course().find("i1.1"))
        node = await asyncio.to_thread(cold.run, THERMOMETER)
        await me.sees("data: 2", "1 node")
        await asyncio.to_thread(cold.interrupt, node)
        await me.sees("No node runs in domain", "silent for", "0 nodes")


async def test_what_my_node_publishes_is_followed_and_shown_by_itself_and_stays_away_once_i_unfollowed_it(
    cold: World,
) -> None:
    async with watching(cold) as me:
        await me.sees("No node runs")
        me.app.pane.show_for(load_course().find("i1.1"))
        me.app.pane.nodes_run(True)
        await asyncio.to_thread(cold.run, METRONOME, "5", "1000")
        await me.sees("/ticks  std_msgs/", "messages · ", "Hz")
        await me.press("delete")
        await me.sees("Not followed: press Enter")
        await asyncio.to_thread(cold.run, THERMOMETER)
        await me.sees("/cmd_vel")
        assert "/ticks" not in me.app.pane.state.topics
        assert "/sensor/temperature" in me.app.pane.state.topics


async def test_a_name_that_is_almost_the_one_asked_for_is_told_with_the_node_that_has_it(cold: World) -> None:
    async with watching(cold, (120, 24)) as me:
        await me.sees("No node runs")
        me.app.pane.show_for(load_course().find("i1.1"))
        slip = ("--ros-args", "-r", "/sensor/temperature:=/sensor/temprature")
        node = await asyncio.to_thread(cold.run, THERMOMETER, "20", *slip)
        await me.sees("/thermometer publishes /sensor/temprature; the exercise asks for /sensor/temperature. Did you")
        me.app.pane.show_for(load_course().find("i1.3"))
        await me.sees_no("Did you mean")
        me.app.pane.show_for(load_course().find("i1.1"))
        await me.sees("Did you mean")
        await asyncio.to_thread(cold.interrupt, node)
        await me.sees_no("Did you mean")


async def test_topics_of_a_lesson_that_i_left_go_with_the_node_that_published_them(cold: World) -> None:
    async with watching(cold) as me:
        me.app.pane.show_for(load_course().find("i1.1"))
        node = await asyncio.to_thread(cold.run, THERMOMETER)
        await me.sees("data: 2")
        me.app.pane.show_for(load_course().find("i1.2"))
        await me.until(lambda: me.topics().chosen == "/chatter")
        await me.sees("/sensor/temperature")
        await asyncio.to_thread(cold.interrupt, node)
        await me.sees_no("/sensor/temperature")
        await me.sees("No node runs")


async def test_the_echo_keeps_what_came_to_be_scrolled_back_to(cold: World) -> None:
    async with watching(cold) as me:
        await me.sees("No node runs")
        me.topics().follow("/ticks")
        await asyncio.to_thread(cold.run, METRONOME, "4", "12")
        echo = me.topics().query_one(EchoView)
        await me.until(lambda: me.count() == 12, "all have come")
        await me.until(lambda: echo.plain.count("---") >= 10, "and are kept")
        await me.until(lambda: echo.is_vertical_scroll_end, "the newest is shown")
        echo.focus()
        await me.press("home")
        await me.until(lambda: echo.scroll_offset.y == 0)
        assert "data: 0" in echo.plain
        await me.press("end")
        await me.until(lambda: echo.is_vertical_scroll_end)


async def test_the_plot_marks_its_samples_and_shows_the_values_that_are_asked_for(cold: World) -> None:
    async with watching(cold, (120, 30)) as me:
        me.app.pane.show_for(load_course().find("i1.1"))
        await asyncio.to_thread(cold.run, THERMOMETER, "2")
        await me.sees("asked: 20 to 30", "•", "╌╌╌", "30┤", "20┤")


async def test_watching_that_breaks_is_told_and_can_begin_again(cold: World) -> None:
    async with watching(cold) as me:
        await me.sees("No node runs")
        child = me.app.pane._child
        assert child is not None
        child.kill()
        await me.sees("Nothing is watched", "! not watching")
        await me.until(lambda: bool(me.app.told), "a toast")
        me.app.pane.start_watching(cold.command)
        await me.sees("No node runs")


async def test_the_app_leaves_at_once_and_nothing_of_it_is_left(cold: World) -> None:
    app = LiveApp(cold)
    async with app.run_test() as pilot:
        while app.pane._child is None:
            await pilot.pause(0.02)
        process = app.pane._child._process
    async with asyncio.timeout(5):
        await process.wait()
