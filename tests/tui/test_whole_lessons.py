"""Whole lessons: the real course, the real engine, and real nodes on a domain of their own."""

from __future__ import annotations

import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from textual.widgets.text_area import Selection

from tests.tui.conftest import Learner, open_app
from tutor.content import load_course
from tutor.content.courses import Courses
from tutor.process.orphans import command_line
from tutor.process.process_table import descendants
from tutor.session import Session
from tutor.tui.live.request_form import FieldRow
from tutor.workspace import AppState, Workspace

pytestmark = pytest.mark.timeout(300)
CHECK_S = 140.0
"""Longest wait for the end of a check, which has limits of its own: one of 19 s takes 64 s beside six busy loops."""


@asynccontextmanager
async def solving(session: Session, exercise: str, size: tuple[int, int] = (120, 36)) -> AsyncIterator[Learner]:
    """A learner whose workspace holds our solution of this exercise."""
    lesson = session.course.find(exercise)
    session.start(lesson)
    for file in lesson.files:
        session.path(file).write_bytes(file.solution.read_bytes())
    session.save_app_state(AppState(lesson=lesson.id))
    async with open_app(session, size) as me:
        await me.sees(f"{lesson.id.upper()}  {lesson.title}", "Objective")
        yield me


async def check_is_over(me: Learner) -> None:
    """Wait for the end of a check that has been started, whatever it says."""
    await me.until(lambda: me.main.checks.running is None, "the end of the check", limit_s=CHECK_S)


def ready_engines() -> list[int]:
    """The pids of the engines that wait for a check."""
    children = [each.pid for each in descendants(os.getpid()) if each.parent == os.getpid()]
    return [pid for pid in children if "tutor.engine --standby" in command_line(pid)]


async def test_a_failure_is_fixed_and_the_pass_is_evidence_in_the_checklist(session: Session) -> None:
    async with solving(session, "i1.3") as me:
        correct = me.file.read_text()
        me.file.write_text(correct.replace("request.a - request.b", "request.b - request.a"))
        await me.press("c")
        await check_is_over(me)
        await me.sees(
            "✗ operations  ",
            "Expected   /subtract: ",
            "Observed   -",
            "operands the wrong way round",
            "3 of 4 passed",
        )

        await me.until(lambda: len(ready_engines()) == 1, "an engine ready for the next check")
        (engine,) = ready_engines()
        await me.press("w")
        await me.sees("a save checks")
        editor = await me.focus_editor()
        wrong = "request.b - request.a"
        line = next(n for n, text in enumerate(editor.text.splitlines()) if wrong in text)
        column = editor.document.get_line(line).index(wrong)
        editor.selection = Selection((line, column), (line, column + len(wrong)))
        me.paste("request.a - request.b")
        await me.press("ctrl+s")
        await me.until(lambda: len(descendants(engine)) > 1, "a node beside the fork server", limit_s=CHECK_S)
        await check_is_over(me)
        await me.sees("I1.3 Calculator Service passed")
        assert me.file.read_text() == correct
        await me.sees("Next: press Esc, then n for", "4 of 4 passed")

        await me.press("escape", "6")
        await me.sees("0 of 15 ticked", "✓ i1.3 services, operations and client passed")
        await me.press("space", "x")
        await me.sees("(•) Markdown", "checklist.md")
        await me.press("enter")
        exported = session.workspace.root / "checklist.md"
        await me.until(exported.exists, "the export")
        assert exported.read_text().count("- [x] ") == 1
        await me.press("escape", "n")
        await me.sees("I2.1  Parameterized Publisher")


def field_has_focus(me: Learner) -> bool:
    return me.app.focused is not None and any(isinstance(each, FieldRow) for each in me.app.focused.ancestors)


async def test_messages_published_by_hand_once_and_at_a_rate_reach_the_node(session: Session) -> None:
    async with solving(session, "i1.2", (80, 24)) as me:
        await me.press("r")
        await me.sees("Waiting for messages on /chatter")
        await me.press("4")
        await me.sees("/chatter", "1 node")
        await me.press("M")
        await me.sees("Publish a message", "std_msgs/msg/String", "data", "Times per second")
        await me.until(lambda: field_has_focus(me), "the first field has the focus")
        me.paste("Hello: 7")
        await me.press("enter")
        await me.sees("✓ published once on /chatter: 1 listens", "data: 'Hello: 7'")
        await me.press("M")
        await me.sees("Publish a message", "Times per second")
        await me.until(lambda: field_has_focus(me), "the first field has the focus")
        me.paste("Hello: 8")
        await me.press("tab", *"fast", "enter")
        await me.sees("✗ Write a rate")
        await me.press("ctrl+u", *"20", "enter")
        await me.sees("▶ you publish on /chatter at 20 Hz", "data: 'Hello: 8'")
        await me.press("3")
        await me.until(lambda: 'last "Hello: 8"' in me.text("#log-view").replace("\n        ", ""), "the last message")
        await me.press("4", "M")
        await me.sees("■ published on /chatter")


async def test_a_course_from_another_folder_is_played(tmp_path: Path, session: Session) -> None:
    course = Path(__file__).parents[1] / "courses" / "greeting"
    mine = Session(load_course(course), Workspace(tmp_path / "ws"), Courses.find([course]))
    async with solving(mine, "h1.1", (80, 24)) as me:
        await me.press("c")
        await check_is_over(me)
        await me.sees("H1.1 Greeter passed")
