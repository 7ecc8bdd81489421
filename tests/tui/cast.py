"""Record a first exercise as an animated picture: `python -m tests.tui.cast docs/pictures/first_exercise.svg`.

The app is real, as are the node, the check and its verdicts. Somebody has written i1.1, but took the rate for a period;
the check says so, and after the repair it passes. Every step becomes a frame of one SVG, which needs no player.
"""

from __future__ import annotations

import asyncio
import os
import re
import sys
from pathlib import Path

from textual.pilot import Pilot

from tests.tui.screenshots import main_screen, session_with_solutions, svg_of, until
from tutor.judge.verdict import Status
from tutor.session import Session
from tutor.tui.app import TutorApp
from tutor.tui.live.topics_panel import TopicsPanel
from tutor.tui.screens.welcome import WelcomeScreen
from tutor.tui.themes import DARK

SIZE = (120, 34)
RIGHT, WRONG = "create_timer(1.0 / rate,", "create_timer(rate,"


class Cast:
    """The frames so far, each with the seconds for which it is shown."""

    def __init__(self) -> None:
        self.frames: list[tuple[str, float]] = []

    async def show(self, pilot: Pilot[int], seconds: float) -> None:
        """Add what the app shows now."""
        await pilot.pause()
        self.frames.append((svg_of(pilot.app), seconds))

    def svg(self) -> str:
        """The frames, one after the other and again from the first, as one SVG."""
        total = sum(seconds for _, seconds in self.frames)
        box = re.search(r'viewBox="([^"]+)"', self.frames[0][0])
        assert box is not None
        rules, groups, begin = [], [], 0.0
        for number, (frame, seconds) in enumerate(self.frames):
            start, end = 100 * begin / total, 100 * (begin + seconds) / total
            shown = (
                f"0% {{ opacity: {int(number == 0)} }} {start:.3f}% {{ opacity: 1 }} {end:.3f}%, 100% {{ opacity: 0 }}"
            )
            rules.append(f"@keyframes frame{number} {{ {shown} }}")
            rules.append(f".frame{number} {{ opacity: 0; animation: frame{number} {total:g}s step-end infinite }}")
            groups.append(f'<g class="frame{number}">{frame}</g>')
            begin += seconds
        style = "\n".join(rules)
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box[1]}">\n'
            f"<style>\n{style}\n</style>\n{''.join(groups)}\n</svg>\n"
        )


async def begin(cast: Cast, session: Session) -> None:
    """The first screen of somebody who has just installed it."""
    app = TutorApp(session)
    app.animation_level = "none"
    async with app.run_test(size=SIZE) as pilot:
        app.theme = DARK.name
        await until(pilot, lambda: isinstance(app.screen, WelcomeScreen))
        await cast.show(pilot, 2.5)


async def learn(cast: Cast, session: Session) -> None:
    """The lesson, the node as it runs, a check that fails, why, and one that passes."""
    lesson = session.lessons[0]
    node = session.path(lesson.files[0])
    node.write_text(node.read_text().replace(RIGHT, WRONG))
    app = TutorApp(session)
    app.animation_level = "none"
    async with app.run_test(size=SIZE) as pilot:
        app.theme = DARK.name
        await until(pilot, lambda: app.main is not None)
        main = main_screen(pilot)
        await cast.show(pilot, 4.0)

        await pilot.press("r")
        await until(pilot, lambda: bool(main.nodes.running))
        await pilot.press("4")
        topics = main.query_one(TopicsPanel)
        for points in (3, 8, 13):
            await until(pilot, lambda: topics.view is not None and len(topics.view.points) > points)  # noqa: B023
            await cast.show(pilot, 1.5)
        await pilot.press("r")
        await until(pilot, lambda: not main.nodes.running)
        await pilot.press("1")

        await check(cast, pilot)
        await cast.show(pilot, 6.0)
        await pilot.press("x")
        await pilot.pause(0.3)
        await cast.show(pilot, 6.0)
        await pilot.press("escape")

        node.write_text(node.read_text().replace(WRONG, RIGHT))
        await check(cast, pilot)
        result = main.model.findings[lesson.id].result
        assert result is not None
        assert result.verdict is Status.PASSED
        await cast.show(pilot, 5.0)
        await app.close_down()


async def check(cast: Cast, pilot: Pilot[int]) -> None:
    """Press c, and wait for the verdict; show the criteria as they are ticked off."""
    main = main_screen(pilot)
    lesson = main.model.lesson
    await pilot.press("c")
    await until(pilot, lambda: main.checks.running is not None)
    shown = 0  # criteria

    def judged() -> int:
        findings = main.model.findings.get(lesson.id)
        return 0 if findings is None else sum(criterion.verdict is not None for criterion in findings.criteria)

    def running() -> bool:
        return main.checks.running is not None

    while running():
        await until(pilot, lambda: not running() or judged() >= shown + 2)  # noqa: B023
        if running():
            shown = judged()
            await cast.show(pilot, 0.8)


async def main(target: Path) -> None:
    cast = Cast()
    for count, record in ((0, begin), (1, learn)):
        with session_with_solutions(count) as session:
            os.environ["HOME"] = str(session.workspace.root.parent)  # the workspace is shown as ~/ros_tutor_ws
            await record(cast, session)
    target.write_text(cast.svg(), encoding="utf-8")
    print(f"{len(cast.frames)} frames, {target.stat().st_size / 1e6:.1f} MB: {target}")


if __name__ == "__main__":
    asyncio.run(main(Path(sys.argv[1])))
