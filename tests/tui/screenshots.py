"""Takes screenshots of the app in its states: `python -m tests.tui.screenshots DIR [ONLY]` writes one SVG for each.

They are for looking at, not for comparing: do not commit DIR, except for the few that README shows. The lessons are
real, the verdicts fake, and the node runs without ROS; the live page watches a real node. ONLY is part of a size or of
a state's name. Each state is taken dark and light. With `--png`, Chromium, if installed, converts all of them to PNG.
"""

from __future__ import annotations

import asyncio
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

from textual.app import App
from textual.events import Paste
from textual.pilot import Pilot

from tests.live.private_domain import private_domain
from tests.tui import fakes
from tutor.content import load_course
from tutor.judge.events import CheckStarted, CriterionJudged, Event
from tutor.judge.verdict import Status
from tutor.session import Session
from tutor.tui.app import TutorApp
from tutor.tui.dialogs.checklist import ChecklistScreen
from tutor.tui.dialogs.predict import PredictScreen
from tutor.tui.live.topics_panel import TopicsPanel
from tutor.tui.screens.main import MainScreen
from tutor.tui.screens.welcome import WelcomeScreen
from tutor.tui.themes import DARK, LIGHT
from tutor.tui.widgets.code_pane import CodePane
from tutor.workspace import Workspace

LIMIT_S = 60.0
SIZES = ((120, 36), (80, 24), (180, 48))
_FONT_FACE = re.compile(r"\s*@font-face \{.*?\}", re.DOTALL)
_FONTS = '"Fira Code", "DejaVu Sans Mono", Menlo, Consolas, monospace'


async def until(pilot: Pilot[int], condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(LIMIT_S):
        while not condition():
            await pilot.pause(0.02)
    await pilot.pause()


def svg_of(app: App[int]) -> str:
    """What the app shows, as an SVG that loads no fonts from the network."""
    svg = app.export_screenshot(title="ros-tutor")
    return _FONT_FACE.sub("", svg).replace("Fira Code, monospace", _FONTS)


@contextmanager
def session_with_solutions(count: int) -> Iterator[Session]:
    """A real session on a domain of its own. The first `count` lessons are started, their first files solved."""
    with private_domain() as ros_world, tempfile.TemporaryDirectory() as scratch:
        for name in ("ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE"):
            os.environ[name] = ros_world.environ[name]
        session = Session(load_course(), Workspace(Path(scratch) / "ros_tutor_ws"))
        for lesson in session.lessons[:count]:
            session.start(lesson)
            session.path(lesson.files[0]).write_bytes(lesson.files[0].solution.read_bytes())
        yield session


class Album:
    """All screenshots of one terminal size, dark and light."""

    def __init__(self, folder: Path, size: tuple[int, int]) -> None:
        self.folder, self.size = folder, size

    @asynccontextmanager
    async def fake_app(self, *, started: bool = True) -> AsyncIterator[tuple[Pilot[int], fakes.FakeSession]]:
        with tempfile.TemporaryDirectory() as scratch:
            session = fakes.FakeSession(Path(scratch) / "learner", started=started, lessons=load_course())
            if started:
                session.path(session.lessons[0].files[0]).write_text(fakes.NODE)
            async with self.open_app(session) as pilot:
                yield pilot, session
                session.engine.close()

    @asynccontextmanager
    async def open_app(self, session: Session) -> AsyncIterator[Pilot[int]]:
        app = TutorApp(session)
        app.animation_level = "none"
        async with app.run_test(size=self.size) as pilot:
            if session.workspace.exists:
                await fakes.wait_until_ready(app, pilot)
            else:
                await until(pilot, lambda: isinstance(app.screen, WelcomeScreen))
            yield pilot
            await app.close_down()

    async def take(self, pilot: Pilot[int], name: str) -> None:
        for theme in (LIGHT, DARK):
            pilot.app.theme = theme.name
            await pilot.pause()
            shade = theme.name.rsplit("-", 1)[1]
            (self.folder / f"{name}-{self.size[0]}x{self.size[1]}-{shade}.svg").write_text(svg_of(pilot.app))

    async def welcome(self) -> None:
        async with self.fake_app(started=False) as (pilot, _):
            await self.take(pilot, "welcome")
            await pilot.press("f")
            await self.take(pilot, "welcome-folder")

    async def rest(self) -> None:
        async with self.fake_app() as (pilot, _):
            main = main_screen(pilot)
            await self.take(pilot, "lesson")
            await pilot.press("2")
            await until(pilot, lambda: main.query_one(CodePane).editor is not None)
            await self.take(pilot, "code")
            await pilot.press("3")
            await self.take(pilot, "log-empty")
            await pilot.press("n", "2")
            await pilot.pause(0.2)
            await self.take(pilot, "missing")
            for key, name in (
                ("question_mark", "help"),
                ("h", "hint"),
                ("ctrl+p", "palette"),
                ("l", "lessons"),
                ("c", "ask"),
                ("o", "options"),
            ):
                await pilot.press(key)
                if key == "h":
                    await pilot.press("h")
                await pilot.pause(0.5 if key == "ctrl+p" else 0.1)
                await self.take(pilot, name)
                await pilot.press("escape" if key != "l" else "l")
                await pilot.pause()
            await pilot.press("v", "enter")
            await pilot.pause(0.2)
            await self.take(pilot, "solution")

    async def busy(self) -> None:
        async with self.fake_app() as (pilot, _):
            main = main_screen(pilot)
            await pilot.press("r")
            await until(pilot, lambda: any(len(each.state.lines) >= 4 for each in main.nodes.running))
            await self.take(pilot, "running")
            await pilot.press("r")
            await until(pilot, lambda: not main.nodes.running)
            await self.take(pilot, "stopped")

    async def live(self) -> None:
        """The live page, watching the solution of the first lesson."""
        with session_with_solutions(1) as session:
            async with self.open_app(session) as pilot:
                main = main_screen(pilot)
                await pilot.press("4")
                await until(pilot, lambda: (live := main.pages.live) is not None and live.state.ready)
                await pilot.pause(0.5)
                await self.take(pilot, "live-nothing")
                await pilot.press("r")
                await until(pilot, lambda: bool(main.nodes.running))
                await pilot.press("4")
                topics = main.query_one(TopicsPanel)
                await until(pilot, lambda: topics.view is not None and len(topics.view.points) > 20)
                await self.take(pilot, "live")
                for name in ("parameters", "services", "graph"):
                    await pilot.press("right_square_bracket")
                    await pilot.pause(0.7)
                    await self.take(pilot, f"live-{name}")

    async def partner(self) -> None:
        """The solution of the second lesson with a talker beside it; then a misspelled topic name."""
        with session_with_solutions(2) as session:
            first = session.path(session.lessons[0].files[0])
            first.write_text(first.read_text().replace("/sensor/temperature", "/sensor/temprature"))
            async with self.open_app(session) as pilot:
                main = main_screen(pilot)
                await pilot.press("n", "r")
                await until(pilot, lambda: bool(main.nodes.running))
                await pilot.press("b")
                await until(pilot, lambda: len(main.nodes.running) == 2)
                await until(pilot, lambda: any(len(each.state.lines) > 8 for each in main.nodes.running))
                await self.take(pilot, "log-two")
                await pilot.press("4")
                await until(pilot, lambda: main.pages.live is not None and "/chatter" in main.pages.live.state.topics)
                topics = main.query_one(TopicsPanel)
                await until(pilot, lambda: topics.view is not None and topics.view.line_count > 16)
                await self.take(pilot, "live-talker")
                await pilot.press("G")
                await pilot.pause(0.7)
                await self.take(pilot, "live-talker-graph")
                await pilot.press("M")
                await pilot.pause(1.0)
                await self.take(pilot, "publish")
                await pilot.press("escape", "p", "r")  # the first r stops the other lesson's nodes
                await until(pilot, lambda: not main.nodes.running)
                await pilot.press("r")
                await until(pilot, lambda: len(main.nodes.running) == 1)
                await pilot.press("T")
                await until(pilot, lambda: topics.view is not None and len(topics.view.points) > 8)
                await self.take(pilot, "live-near-miss")

    async def terminal(self) -> None:
        """Two terminals with the solution of the first lesson: a rate in one; the topic's messages in the other."""
        with session_with_solutions(1) as session:
            async with self.open_app(session) as pilot:
                main = main_screen(pilot)
                pane = main.pages.open_terminal()
                await pilot.press("7")

                async def enter(line: str, expected: str) -> None:
                    await until(pilot, lambda: pane.shown is not None and pane.shown.program is not None)
                    view = pane.shown
                    assert view is not None
                    await until(pilot, lambda: view.program is not None and view.program.reads_keys)
                    if line:
                        pilot.app.post_message(Paste(line))
                        await pilot.press("enter")
                    await until(pilot, lambda: expected in view.plain)

                await enter("", "ROS 2")
                await self.take(pilot, "terminal-nothing")
                await enter("ros2 run my_package temperature_publisher", "°C")
                await pilot.press("ctrl+right_square_bracket", "plus")
                await enter("ros2 topic info /sensor/temperature", "Subscription count")
                await enter("ls --color=always src/my_package", "setup.py")
                await enter("ros2 topic hz /sensor/temperature", "average rate")
                await self.take(pilot, "terminal")
                await pilot.press("ctrl+right_square_bracket")
                await pilot.pause(0.7)
                await self.take(pilot, "terminal-tabs")

    async def check(self, passing: bool) -> None:
        async with self.fake_app() as (pilot, session):
            main = main_screen(pilot)
            lesson = session.lessons[0]
            await pilot.press("c")
            names = [c.id for c in lesson.criteria]
            events: list[Event] = [CheckStarted(lesson.id, tuple(names))]
            events += [
                fakes.progress_event(names[n], f, t, lesson.id, so_far) for n, f, t, so_far in STEPS if n < len(names)
            ]
            events += [CriterionJudged(lesson.id, fakes.result(names[0], fakes.GOOD))]
            await asyncio.to_thread(session.engine.emit, *events)
            await until(pilot, lambda: main.model.findings[lesson.id].criteria[0].verdict is not None)
            if not passing:
                await self.take(pilot, "checking")
                failed = CriterionJudged(lesson.id, fakes.result("rate", fakes.BAD))
                await asyncio.to_thread(session.engine.emit, failed)
                await until(pilot, lambda: main.chosen_criterion == "rate")
                await self.take(pilot, "checking-failed")
            await asyncio.to_thread(
                session.engine.emit, *fakes.lesson_final_events(lesson, fakes.GOOD if passing else fakes.BAD)
            )
            session.engine.close()
            await until(pilot, lambda: main.checks.running is None)
            await until(pilot, lambda: main.model.progress.of(lesson.id).last is not None)
            result = main.model.findings[lesson.id].result
            assert result is not None
            assert (result.verdict is Status.PASSED) == passing
            await self.take(pilot, "passed" if passing else "failed")
            if passing:
                await pilot.press("V")
                await pilot.pause(0.5)
                await self.take(pilot, "solution")
                await pilot.press("z")
                await pilot.pause(0.3)
                await self.take(pilot, "solution-zoomed")
                await pilot.press("z", "escape")
                await pilot.pause(0.2)
            await pilot.press("6")
            await pilot.pause(0.3)
            await self.take(pilot, "checklist" if passing else "checklist-begun")
            await pilot.press("escape", "a")
            await pilot.pause(0.2)
            await self.take(pilot, "attempts")

    async def checked(self) -> None:
        await self.check(passing=False)
        await self.check(passing=True)

    async def ready(self) -> None:
        async with self.fake_app() as (pilot, session):
            for item in session.course.checklist.items[:-1]:
                session.tick(item.id, True)
            await pilot.press("6")
            await until(pilot, lambda: isinstance(pilot.app.screen, ChecklistScreen) and pilot.app.screen.is_mounted)
            await pilot.press("end", "space")
            await until(pilot, lambda: pilot.app.screen.query_one("#checklist-ready").display)
            await self.take(pilot, "ready")
            await pilot.press("x")
            await pilot.pause(0.1)
            await self.take(pilot, "export")

    async def predict(self) -> None:
        """A prediction: the question, and what was seen after a wrong answer; the program is run."""
        with session_with_solutions(1) as session:
            async with self.open_app(session) as pilot:
                await main_screen(pilot).go_to(session.course.find("i2.3"))
                await pilot.pause()
                await self.take(pilot, "predict-footer")
                await pilot.press("8")
                await until(pilot, lambda: isinstance(pilot.app.screen, PredictScreen))
                await self.take(pilot, "predict")
                await pilot.press("n", "n", "2")
                await until(pilot, lambda: isinstance(screen := pilot.app.screen, PredictScreen) and screen.told)
                await self.take(pilot, "predict-seen")

    async def crash(self) -> None:
        async with self.fake_app() as (pilot, session):
            await pilot.press("c")
            await asyncio.to_thread(session.engine.emit, "crash")
            await until(pilot, lambda: main_screen(pilot).checks.running is None)
            await self.take(pilot, "crashed")


STEPS = (  # progress events: the index of the criterion, fraction, text, findings so far
    (1, 0.8, "listening for 2 s more", ""),
    (2, 0.35, "collecting 20 values, 7 so far", ""),
    (
        3,
        0.5,
        "subscribing as ros2 topic echo does",
        "nothing published on /sensor/temperature yet, /temperature_publisher is up",
    ),
    (
        *(4, 0.6, "setting publish_rate to 5.0, and measuring the rate that follows from it"),
        "likely no messages: there is a publisher on /sensor/temperature, but nothing calls publish()",
    ),
)


def main_screen(pilot: Pilot[int]) -> MainScreen:
    assert isinstance(pilot.app, TutorApp)
    assert pilot.app.main is not None
    return pilot.app.main


def write_png(picture: Path) -> None:
    """Write it next to the SVG as Chromium renders it."""
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    assert chromium is not None, "Chromium is not installed"
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run(
            [
                chromium,
                *("--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run"),
                *("--hide-scrollbars", "--window-size=1500,1000", f"--user-data-dir={profile}"),
                f"--screenshot={picture.with_suffix('.png')}",
                picture.resolve().as_uri(),
            ],
            check=True,
            stderr=subprocess.DEVNULL,
        )


async def main(folder: Path, only: str = "") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for size in SIZES:
        album = Album(folder, size)
        states = (album.welcome, album.rest, album.busy, album.live, album.terminal, album.partner)
        for group in (*states, album.checked, album.ready, album.predict, album.crash):
            if only in f"{size[0]}x{size[1]} {group.__name__}":
                await group()
    print(f"{len(list(folder.glob('*.svg')))} screenshots in {folder}")


if __name__ == "__main__":
    arguments = [each for each in sys.argv[1:] if each != "--png"]
    asyncio.run(main(Path(arguments[0]), *arguments[1:2]))
    if "--png" in sys.argv:
        for each in sorted(Path(arguments[0]).glob("*.svg")):
            write_png(each)
