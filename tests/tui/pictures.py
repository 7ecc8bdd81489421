"""Takes pictures of the app in its states: `python tests/tui/pictures.py DIR` writes one SVG for each.

For looking at, not for comparing. Real lessons, made verdicts, a node without ROS.
"""

from __future__ import annotations

import asyncio
import sys
import tempfile
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

from textual.pilot import Pilot

from tests.tui import made
from tutor.content import load_course
from tutor.judge.events import CheckStarted, CriterionJudged, Event
from tutor.judge.verdict import Status
from tutor.tui.app import TutorApp
from tutor.tui.screens.main import MainScreen
from tutor.tui.screens.welcome import WelcomeScreen
from tutor.tui.themes import DARK, LIGHT
from tutor.tui.widgets.code_pane import CodePane

LIMIT_S = 10.0


async def until(pilot: Pilot[int], seen: Callable[[], bool]) -> None:
    async with asyncio.timeout(LIMIT_S):
        while not seen():
            await pilot.pause(0.02)
    await pilot.pause()


class Album:
    """One size and theme."""

    def __init__(self, folder: Path, size: tuple[int, int], theme: str) -> None:
        self.folder, self.size, self.theme = folder, size, theme

    @asynccontextmanager
    async def opened(self, *, started: bool = True) -> AsyncIterator[tuple[Pilot[int], made.MadeDesk]]:
        with tempfile.TemporaryDirectory() as scratch:
            desk = made.MadeDesk(Path(scratch) / "learner", started=started, lessons=load_course())
            if started:
                desk.path(desk.lessons[0].files[0]).write_text(made.NODE)
            app = TutorApp(desk)
            async with app.run_test(size=self.size) as pilot:
                app.theme = self.theme
                if started:
                    await made.opened(app, pilot)
                else:
                    await until(pilot, lambda: isinstance(app.screen, WelcomeScreen))
                yield pilot, desk
                desk.engine.close()
                if app.main is not None:
                    await app.main.close_down()

    def take(self, pilot: Pilot[int], name: str) -> None:
        place = self.folder / f"{name}-{self.size[0]}x{self.size[1]}-{self.theme.rsplit('-', 1)[1]}.svg"
        place.write_text(pilot.app.export_screenshot(title="ros-tutor"))

    async def rest(self) -> None:
        async with self.opened(started=False) as (pilot, _):
            self.take(pilot, "welcome")
        async with self.opened() as (pilot, _):
            main = screen(pilot)
            await until(pilot, lambda: bool(main.session.progress.exercises))
            self.take(pilot, "lesson")
            await pilot.press("2")
            await until(pilot, lambda: main.query_one(CodePane).editor is not None)
            self.take(pilot, "code")
            await pilot.press("n", "2")
            await pilot.pause(0.1)
            self.take(pilot, "missing")
            for key, name in (
                ("question_mark", "help"),
                ("h", "hint"),
                ("ctrl+p", "palette"),
                ("l", "lessons"),
                ("c", "ask"),
            ):
                await pilot.press(key)
                if key == "h":
                    await pilot.press("h")
                await pilot.pause(0.3 if key == "ctrl+p" else 0.05)
                self.take(pilot, name)
                await pilot.press("escape" if key != "l" else "l")
                await pilot.pause()
            await pilot.press("v", "enter")
            await pilot.pause(0.1)
            self.take(pilot, "solution")

    async def busy(self) -> None:
        async with self.opened() as (pilot, _):
            main = screen(pilot)
            await pilot.press("r")
            await until(pilot, lambda: any(len(each.state.lines) >= 4 for each in main.nodes.running))
            self.take(pilot, "running")
            await pilot.press("r")
            await until(pilot, lambda: not main.nodes.running)
            self.take(pilot, "stopped")

    async def check(self, passing: bool) -> None:
        async with self.opened() as (pilot, desk):
            main = screen(pilot)
            lesson = desk.lessons[0]
            await pilot.press("c")
            names = [c.id for c in lesson.criteria]
            say: list[Event] = [CheckStarted(lesson.id, tuple(names))]
            say += [made.doing(names[n], f, t, lesson.id) for n, f, t in STEPS if n < len(names)]
            say += [CriterionJudged(lesson.id, made.result(names[0], made.GOOD))]
            await asyncio.to_thread(desk.engine.say, *say)
            await until(pilot, lambda: main.session.findings[lesson.id].criteria[0].verdict is not None)
            if not passing:
                self.take(pilot, "checking")
            await asyncio.to_thread(desk.engine.say, *made.whole(lesson, made.GOOD if passing else made.BAD))
            desk.engine.close()
            await until(pilot, lambda: main.checks.running is None)
            await until(pilot, lambda: main.session.progress.of(lesson.id).last is not None)
            found = main.session.findings[lesson.id].result
            assert found is not None
            assert (found.verdict is Status.PASSED) == passing
            self.take(pilot, "passed" if passing else "failed")

    async def crash(self) -> None:
        async with self.opened() as (pilot, desk):
            await pilot.press("c")
            await asyncio.to_thread(desk.engine.say, "crash")
            await until(pilot, lambda: screen(pilot).checks.running is None)
            self.take(pilot, "crashed")


STEPS = (
    (1, 0.8, "listening for 2 s more"),
    (2, 0.35, "collecting 20 values, 7 so far"),
    (3, 0.5, "subscribing as ros2 topic echo does"),
    (4, 0.6, "setting publish_rate to 5.0, and measuring the rate that follows from it"),
)


def screen(pilot: Pilot[int]) -> MainScreen:
    assert isinstance(pilot.app, TutorApp)
    assert pilot.app.main is not None
    return pilot.app.main


async def main(folder: Path, only: str = "") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for size in ((120, 36), (80, 24), (180, 48)):
        for theme in (DARK.name, LIGHT.name):
            if only not in f"{size[0]}{theme}":
                continue
            album = Album(folder, size, theme)
            await album.rest()
            await album.busy()
            await album.check(passing=False)
            await album.check(passing=True)
            await album.crash()
    print(f"{len(list(folder.glob('*.svg')))} pictures in {folder}")


if __name__ == "__main__":
    asyncio.run(main(Path(sys.argv[1]), *sys.argv[2:3]))
