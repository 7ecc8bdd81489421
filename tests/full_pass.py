"""Passes the whole course as a learner would, on the command line, and shows the checklist that they then have.

    uv run python -m tests.full_pass [PICTURE.svg]

Each exercise is started, solved with our solution and checked; each prediction is answered. A fault that is handed over
is reported and repaired. Prints each item of the checklist with its evidence; the exit code is 1 if an item has none.
PICTURE: the checklist as the app shows it.
"""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.tui.screenshots import Album, svg_of, until
from tutor.content import Lesson, load_course
from tutor.content.cases import cases_of
from tutor.report.assessment import AssessedItem
from tutor.report.phrases import calendar_day, describe_evidence
from tutor.session import Session
from tutor.session.predictions import run_prediction
from tutor.tui.dialogs.checklist import ChecklistScreen
from tutor.workspace import Workspace

SIZE = (120, 50)


def tutor(*arguments: str) -> None:
    """Run a command of ros-tutor, which must end with exit code 0."""
    print("ros-tutor", *arguments, file=sys.stderr, flush=True)
    subprocess.run([sys.executable, "-m", "tutor", *arguments], check=True, stdout=subprocess.DEVNULL)


def do(session: Session, lesson: Lesson) -> None:
    """Start an exercise, put our solution into its files, report its fault if it has one, predict, and check."""
    tutor("start", lesson.id)
    if cases := cases_of(lesson):
        case = cases.find(session.handed_over.drawn(lesson).current)
        assert case is not None
        tutor("answer", lesson.id, case.what[0], case.where)
    for file in lesson.files:
        if cases is None or file.name != cases.report:
            session.path(file).write_bytes(file.solution.read_bytes())
    for prediction in lesson.predictions:
        outcome = asyncio.run(run_prediction(prediction, lambda state: None))
        assert outcome.holds is not None, outcome.problem
        tutor("predict", lesson.id, prediction.id, "--answer", str(outcome.holds + 1))
    tutor("check", lesson.id)


async def picture_of(session: Session) -> str:
    """The checklist as the app shows it, as an SVG."""
    async with Album(Path(), SIZE).open_app(session) as pilot:
        await pilot.press("6")
        await until(pilot, lambda: isinstance(pilot.app.screen, ChecklistScreen) and pilot.app.screen.is_mounted)
        await pilot.pause(0.5)
        return svg_of(pilot.app)


def main() -> int:
    """Return exit code 0 if each item of the checklist has evidence that holds."""
    with tempfile.TemporaryDirectory() as home:
        os.environ |= {"HOME": home, "XDG_CONFIG_HOME": f"{home}/.config", "XDG_STATE_HOME": f"{home}/.state"}
        session = Session(load_course(), Workspace(Path(home) / "ros_tutor_ws"))
        for lesson in session.lessons:
            do(session, lesson)
        items = session.assess().items
        for item in items:
            print(f"{'✓' if item.shown else '✗'} {item.text}", *_evidence(item), sep="\n    ")
        print(f"{sum(item.shown for item in items)} of {len(items)} items have evidence")
        if len(sys.argv) > 1:
            Path(sys.argv[1]).write_text(asyncio.run(picture_of(session)), encoding="utf-8")
    return 0 if all(item.shown for item in items) else 1


def _evidence(item: AssessedItem) -> list[str]:
    return describe_evidence(item.evidence, calendar_day)


if __name__ == "__main__":
    sys.exit(main())
