"""Take screenshots of the live page in its states, for visual review: `python -m tests.live.pictures DIR`."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable
from pathlib import Path

from textual.pilot import Pilot

from tests.live.private_domain import THERMOMETER, LiveApp, PrivateDomain, private_domain
from tutor.content import load_course
from tutor.tui.live.services_panel import ServicesPanel
from tutor.tui.live.topics_panel import TopicsPanel
from tutor.tui.themes import DARK, LIGHT

LIMIT_S = 20.0


async def wait_until(pilot: Pilot[int], condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(LIMIT_S):
        while not condition():
            await pilot.pause(0.05)
    await pilot.pause()


async def take_all(folder: Path, ros_world: PrivateDomain, size: tuple[int, int], theme: str) -> None:
    def take(name: str) -> None:
        file = folder / f"live-{name}-{size[0]}x{size[1]}-{theme.rsplit('-', 1)[1]}.svg"
        file.write_text(app.export_screenshot(title="live"))

    app = LiveApp(ros_world)
    app.theme = theme
    async with app.run_test(size=size, notifications=True) as pilot:
        state, pane = app.pane.state, app.pane
        take("starting")
        await wait_until(pilot, lambda: state.ready)
        await pilot.pause(0.3)
        take("nothing")
        node = ros_world.run(THERMOMETER)
        pane.set_lesson(load_course().find("i1.1"))
        topics = pane.query_one(TopicsPanel)
        await wait_until(pilot, lambda: topics.view is not None and len(topics.view.points) > 60)
        take("topics")
        topics.follow("/cmd_vel")
        await wait_until(pilot, lambda: topics.view is not None and len(topics.view.points) > 40)
        await pilot.press("y", "y", "y", "y", "y")
        await wait_until(pilot, lambda: topics.view is not None and len(topics.view.points) > 10)
        take("nested")
        await pilot.press("space")
        await pilot.pause(0.5)
        take("paused")
        topics.follow("/rosout")
        await pilot.pause(0.3)
        take("unheard")
        await pilot.press("right_square_bracket")
        await wait_until(pilot, lambda: bool(state.listed_parameters()))
        await pilot.press("down", "enter")
        take("editing")
        await pilot.press("enter", "down", "enter", "delete", "enter")
        await wait_until(pilot, lambda: len(state.sets) > 1)
        await pilot.press("up", "enter", *"x", "enter")
        take("parameters")
        await pilot.press("escape", "right_square_bracket")
        await pilot.pause(0.2)
        take("services")
        await pilot.press("enter")
        form = pane.query_one(ServicesPanel)
        await wait_until(
            pilot, lambda: app.focused is not None and app.focused.parent is not None and bool(form.chosen)
        )
        await pilot.press(*"4x", "enter")
        take("wrong")
        await pilot.press("backspace", "tab", *"2", "enter")
        await wait_until(pilot, lambda: len(state.calls) > 0)
        await form.choose(next(each for each in form._listed if each.name == "/slow_add"))
        await pilot.press("enter")
        await pilot.pause(0.5)
        take("calling")
        await pilot.press("escape", "escape", "right_square_bracket")
        await pilot.pause(0.3)
        take("graph")
        await pilot.press("u")
        take("graph-all")
        ros_world.interrupt(node)
        await pilot.press("right_square_bracket")
        await wait_until(pilot, lambda: not state.nodes)
        await pilot.pause(1.0)
        take("ended")
        await pane.close_down()


async def main(folder: Path, only: str = "") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for size in ((78, 18), (84, 26), (120, 40)):
        for theme in (DARK.name, LIGHT.name):
            if only in f"{size[0]}{theme}":
                with private_domain() as ros_world:
                    await take_all(folder, ros_world, size, theme)
    print(f"{len(list(folder.glob('live-*.svg')))} pictures in {folder}")


if __name__ == "__main__":
    asyncio.run(main(Path(sys.argv[1]), *sys.argv[2:3]))
