"""The self-assessment checklist: ticking, evidence from the checks, completion, and export."""

from __future__ import annotations

import asyncio
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.widgets import Input

from tests.tui import fakes
from tests.tui.conftest import Learner
from tutor.content import load_course
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status
from tutor.tui.dialogs.checklist import ChecklistScreen
from tutor.tui.dialogs.export import ExportScreen
from tutor.workspace import Attempt, ExerciseProgress, Help, digests_of
from tutor.workspace.progress import now


@pytest.fixture
def course(monkeypatch: pytest.MonkeyPatch) -> None:
    """The real lessons and the real checklist."""
    monkeypatch.setattr(fakes, "course", lambda folder: load_course())


pytestmark = pytest.mark.usefixtures("course")


def checklist_screen(me: Learner) -> ChecklistScreen:
    screen = me.app.screen
    assert isinstance(screen, ChecklistScreen)
    return screen


def ticks(me: Learner) -> set[str]:
    return set(me.session.progress().ticks)


def course_total(me: Learner) -> int:
    """How many exercises the course has, without those that go beyond it."""
    return sum(not lesson.beyond for lesson in me.session.lessons)


def record_attempt(me: Learner, exercise: str, *criteria: str) -> None:
    """Record a check from another terminal in which only these criteria passed, by code of the skeleton."""
    version = me.session.versions()[exercise]
    attempt = Attempt(now(), Status.FAILED, criteria, version=version, given=("shutdown",), help=Help.HINTS)
    done = ExerciseProgress(now(), (attempt,), Status.FAILED)
    me.session.workspace.progress(print).change(lambda progress: progress.with_exercise(exercise, done))


async def test_ticks_are_saved_at_once(learner: Any) -> None:
    async with learner() as me:
        await me.sees("6 Checklist")
        await me.press("6")
        await me.sees("0 of 15 ticked", "rclpy Fundamentals", "Communication Patterns", "0 of 3")
        await me.press("space")
        await me.sees("1 of 15 ticked", "1 of 4", "[✓] Create nodes that publish and nodes that subscribe")
        await me.until(lambda: ticks(me) == {"publish-and-subscribe"}, "saved")
        await me.press("down", "enter", "up", "space")
        await me.sees("1 of 15 ticked", "[ ] Create nodes that publish and nodes that subscribe")
        await me.until(lambda: ticks(me) == {"timers"}, "saved")

        # By mouse: ticked, then unticked and ticked again as fast as one can click.
        item = "#item-callback-groups"
        await me.pilot.click(item)
        await me.sees("2 of 15 ticked", "[✓] Use callback groups the right way")
        await me.pilot.click(item)
        await me.pilot.click(item)
        await me.sees("2 of 15 ticked")
        await me.until(lambda: ticks(me) == {"timers", "callback-groups"}, "saved")

        # With the arrow keys from card to card.
        order = [row.item.id for row in checklist_screen(me).rows]
        for key, place in (("home", 0), ("right", 4), ("left", 0), ("end", -1), ("down", -1), ("left", -5), ("up", -6)):
            await me.press(key)
            assert me.app.focused is not None
            assert me.app.focused.id == f"item-{order[place]}", key

        # A tick that cannot be saved is not shown as saved.
        file = me.session.workspace.progress(print).path
        text = file.read_text()
        file.unlink()
        file.mkdir()  # as good as a broken disk, even for root
        await me.press("space")
        await me.sees("Your progress could not be saved", "2 of 15 ticked")
        file.rmdir()
        file.write_text(text)

        await me.press("escape")
        await me.until(lambda: me.app.screen is me.main, "back")
        await me.press("6")
        await me.sees("2 of 15 ticked", "[✓] Call a function at a fixed period with a timer")


async def test_each_item_shows_the_evidence_from_checks(learner: Any) -> None:
    async with learner((180, 48)) as me:
        lesson = me.session.course.find("i2.1")
        await asyncio.to_thread(me.session.start, lesson)
        record_attempt(me, "i2.1", "validation", "shutdown")
        await me.press("6")
        await me.sees("✓ i2.1 validation passed with hints, today", "1 shown by your checks")
        await me.press("escape")
        me.session.path(lesson.files[0]).write_text("# another version\n")
        await me.press("6")
        await me.sees("○ i2.1 validation passed with hints today, since changed", "0 shown by your checks")
        await me.sees("○ not yet shown by i2.1 runtime-params and timer")
        await me.sees("○ not yet shown by i2.3 shutdown and shutdown-busy")  # the others' skeletons pass it, too
        assert "[ ] Refuse parameter values that make no sense" in me.screen()  # only the learner ticks items

        # While the checklist is open, a check ends, and another terminal ticks an item.
        lesson = me.session.course.find("i1.1")
        judged = tuple(CriterionResult(c.id, c.text, c.bonus, fakes.GOOD, 1.0) for c in lesson.criteria)
        await asyncio.to_thread(me.session.tick, "custom-messages", True)
        await asyncio.to_thread(me.session.start, lesson)
        digests = digests_of({file.name: me.session.path(file) for file in lesson.files})
        me.main.records.record_attempt(ExerciseResult(lesson.id, lesson.title, (), judged, 4.2, digests=digests))
        await me.sees("✓ i1.1 rate passed, today", "✓ i1.1 shutdown passed, today", "1 of 15 ticked")


async def test_ticking_the_last_item_in_a_small_terminal_shows_what_comes_next(learner: Any) -> None:
    async with learner((80, 24)) as me:
        *most, last = (item.id for item in me.session.course.checklist.items)
        already = dict.fromkeys(most, now())
        me.session.workspace.progress(print).change(lambda progress: replace(progress, ticks=already))
        await me.sees("6 Checklist", "q Quit")
        await me.press("ctrl+p")
        me.paste("do by now")
        await me.sees("Tick what you can do by now")
        await me.press("down", "enter")
        await me.sees("14 of 15 ticked", "Space Tick", "x Export", "Esc Back")
        for row in checklist_screen(me).rows:
            assert me.app.focused is row
            await me.sees(f"[{' ' if row.item.id == last else '✓'}] {row.item.text[:40]}")
            assert "Ready for Advanced?" not in me.screen()
            await me.press("down")
        await me.press("space")
        await me.sees(
            "15 of 15 ticked",
            "Ready for Advanced?",
            "Well done!",
            "URDF",
            f"{course_total(me)} exercises are not passed yet",
        )
        await me.sees("[✓] Say when two callbacks", "Esc Back")  # the banner hides neither the item nor the keys
        await me.until(lambda: len(ticks(me)) == 15, "saved")
        await me.press("x")
        await me.sees("Export the checklist", "(•) Markdown", "A new file in", "Enter exports")
        await me.press("enter")
        await me.sees("Your checklist is in")
        text = (me.session.workspace.root / "checklist.md").read_text()
        assert text.count("- [x] ") == 15
        assert "## Ready for Advanced?" in text
        await me.press("space")
        await me.until(lambda: "Ready for Advanced?" not in me.screen())


async def test_each_format_is_exported_and_no_file_is_replaced_without_asking(learner: Any) -> None:
    async with learner((80, 24)) as me:
        root: Path = me.session.workspace.root
        page = root / "checklist.html"
        page.write_text("mine")
        await me.press("6")
        await me.sees("0 of 15 ticked")
        await me.press("space", "x")  # the export has the tick, however soon it comes
        await me.sees("(•) Markdown", "checklist.md")
        await me.press("down")
        await me.sees("(•) JSON", "checklist.json")
        await me.press("enter")
        await me.until(lambda: (root / "checklist.json").exists(), "written")
        assert json.loads((root / "checklist.json").read_text())["ticked"] == 1

        await me.until(lambda: isinstance(me.app.screen, ChecklistScreen), "back")
        await me.press("x")
        await me.sees("(•) Markdown")
        await me.pilot.click("#format-html")
        await me.sees("(•) HTML page", "checklist.html", "There already, in")
        await me.pilot.click("#yes")
        await me.sees("Replace the file?")
        await me.press("escape")
        await me.sees("Export the checklist", "checklist.html")  # back in the dialog, perhaps to change the name
        assert page.read_text() == "mine"
        await me.press("enter")
        await me.sees("Replace the file?")
        await me.press("enter")
        await me.until(lambda: page.read_text().startswith("<!DOCTYPE html>"), "replaced")

        # Another path.
        await me.until(lambda: isinstance(me.app.screen, ChecklistScreen), "back")
        await me.press("x")
        await me.sees("(•) Markdown")
        me.paste("no/x.json")
        await me.sees("(•) JSON", "There is no folder")
        await me.press("enter")
        assert isinstance(me.app.screen, ExportScreen)
        await me.press("ctrl+u", *"y.json", "enter")
        await me.until(lambda: (root / "y.json").exists(), "written")

        # A name too long for any file system.
        await me.until(lambda: isinstance(me.app.screen, ChecklistScreen), "back")
        await me.press("x")
        await me.sees("(•) Markdown")
        me.app.screen.query_one(Input).value = "n" * 300
        await me.press("enter")
        await me.sees("Your checklist could not be written")


async def test_the_last_pass_leads_to_the_checklist_where_capital_x_exports_too(learner: Any) -> None:
    async with learner() as me:
        lessons, total = me.session.lessons, course_total(me)
        done = {lesson.id: ExerciseProgress(now(), (), Status.PASSED) for lesson in lessons[1:total]}
        me.session.workspace.progress(print).change(
            lambda progress: replace(progress, exercises={**progress.exercises, **done})
        )
        me.main.records.read()
        await me.sees(f"{total - 1} of {total} passed")
        await me.start_check()
        await me.engine_emits(*fakes.lesson_final_events(me.session.lessons[0], fakes.GOOD))
        await me.sees("Every exercise of the course is passed now.", "Next: press 6 for the checklist, n for ")
        await me.sees(f"{total} of {total} passed, 0 of {len(lessons) - total} beyond")
        await me.press("6")
        await me.sees("of 15 ticked")
        await me.press("X")
        await me.sees("(•) Markdown", "checklist.md")
