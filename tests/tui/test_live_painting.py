"""What the live page paints while a fast topic is in view: what has changed, and no layout of the whole screen."""

from __future__ import annotations

import time
from typing import Any

import pytest
from textual.widgets import DataTable

from tutor.live.protocol import Ready
from tutor.live.updates import TopicUpdate
from tutor.ros_model import Graph, QoS, Timing, TopicEndpoint
from tutor.tui.live.echo_view import EchoView
from tutor.tui.live.pane import LivePane
from tutor.tui.live.plot_view import PlotView
from tutor.tui.live.topics_panel import TopicsPanel
from tutor.tui.screens.main import MainScreen

TICKS = TopicEndpoint("/ticks", "std_msgs/msg/Float64", "/metronome")
GRAPH = Graph(("/metronome",), (TICKS, TopicEndpoint("/other", "std_msgs/msg/Empty", "/metronome")))


@pytest.fixture(autouse=True)
def no_watcher(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have no watcher process send updates of its own."""
    monkeypatch.setattr(LivePane, "start_watching", lambda pane, command: None)


def update(number: int) -> TopicUpdate:
    timing = Timing(200, 0.001, 0.0001, 0.0009, 0.0011)
    now = time.time()
    return TopicUpdate(
        TICKS.topic,
        TICKS.type,
        QoS(),
        1000 + number,
        0,
        timing,
        0.0,
        f"data: {number}",
        ("data",),
        "data",
        ((now - 0.1, float(number)), (now, number + 0.5)),
    )


async def show(me: Any, *updates: Any) -> None:
    """Have the live page receive these updates, and wait until they are painted."""
    pane = me.main.query_one(LivePane)
    for each in updates:
        pane.post_message(LivePane.Arrived(each))
        await me.pilot.pause()


async def watch_ticks(me: Any) -> None:
    """Open the live page with /ticks in view, until its echo is longer than the view."""
    await me.press("4")
    await me.until(lambda: bool(me.main.query(TopicsPanel)))
    await show(me, Ready(3), GRAPH)
    me.main.query_one(TopicsPanel).follow(TICKS.topic)
    await show(me, *(update(number) for number in range(40)))
    await me.sees("data: 39")
    await me.until(lambda: me.main.query_one(EchoView).show_vertical_scrollbar)


async def test_a_message_lays_nothing_out(learner: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    async with learner(size=(120, 36)) as me:
        await watch_ticks(me)
        layouts = []
        lay_out = MainScreen._refresh_layout

        def count(screen: MainScreen, *args: Any, **options: Any) -> None:
            layouts.append(screen)
            lay_out(screen, *args, **options)

        await me.pilot.pause(0.1)
        monkeypatch.setattr(MainScreen, "_refresh_layout", count, raising=False)
        await show(me, *(update(number) for number in range(40, 50)))
        await me.sees("data: 49")
        assert layouts == []
        echo = me.main.query_one(EchoView)
        assert echo.vertical_scrollbar.window_virtual_size == len(echo.rows) == 100
        assert echo.is_vertical_scroll_end


async def test_only_the_cells_that_changed_are_rendered_again(learner: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    async with learner(size=(120, 36)) as me:
        await watch_ticks(me)
        await me.sees("/other")
        rendered: list[tuple[int, int]] = []
        render = DataTable._render_cell

        def record(table: DataTable[Any], row: int, column: int, *args: Any, **options: Any) -> Any:
            rendered.append((row, column))
            return render(table, row, column, *args, **options)

        monkeypatch.setattr(DataTable, "_render_cell", record)
        panel = me.main.query_one(TopicsPanel)
        await show(me, update(60))
        panel._update_rows()
        await me.sees("1,060")
        assert set(rendered) == {(1, 3)}  # its count
        panel.table.move_cursor(row=0)  # another row under the cursor: other colours
        await me.until(lambda: {(0, 1), (1, 1)} <= set(rendered))


async def test_the_plot_and_the_table_follow_the_theme(learner: Any) -> None:
    async with learner(size=(120, 36)) as me:
        await watch_ticks(me)

        def colours() -> tuple[set[object], set[object]]:
            plot, table = me.main.query_one(PlotView), me.main.query_one("#topics-table")
            strips = [plot.render_line(y) for y in range(plot.size.height)]
            return (
                {segment.style.color for strip in strips for segment in strip if segment.style},
                {segment.style.color for segment in table.render_line(1) if segment.style},
            )

        plot, table = colours()
        assert len(plot) > 1  # the axis and the line
        await me.press("t")
        await me.until(lambda: plot.isdisjoint(colours()[0]) and table.isdisjoint(colours()[1]))
