"""An exercise that hands over a system: the learner answers what is wrong and where, and asks for another fault."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tests.tui.conftest import open_app
from tutor.content.cases import read_report
from tutor.session import Session
from tutor.session.findings import Findings
from tutor.tui.dialogs.answer import AnswerScreen


async def test_the_answer_is_chosen_by_keys_and_written_into_the_report(session: Session) -> None:
    lesson = session.course.find("b1.7")
    session.start(lesson)
    report = session.workspace.path_of("courier_report.yaml")
    first = session.handed_over.drawn(lesson).current
    async with open_app(session, (120, 36)) as me:
        await go_to_lesson(me, "b1.7")
        await me.press("A")
        await me.sees("What is wrong?", "the QoS of the two ends of a topic does not match", "courier_battery.py")
        await me.press("escape")
        await me.sees_no("What is wrong?")
        assert read_report(report.read_text()).what == ""
        await me.press("A")
        await me.until(lambda: isinstance(me.app.screen, AnswerScreen))
        await me.press("down", "enter", "down", "down", "enter")
        await me.sees("Reported: the two ends of a topic have different")
        found = read_report(report.read_text())
        assert (found.case, found.what, found.where, found.tries) == (first, "type", "courier_launch.py", 1)

        await me.press("A")
        await me.until(lambda: isinstance(me.app.screen, AnswerScreen))
        await me.press("enter", "enter")  # what was answered before is chosen already
        await me.until(lambda: not isinstance(me.app.screen, AnswerScreen))
        assert read_report(report.read_text()) == found

        await me.press("r")
        await me.until(lambda: bool(me.main.nodes.running), "the system runs")
        me.main.model.findings["b1.7"] = replace(me.main.model.findings["b1.7"], note="judged before")
        await me.press("N")
        await me.sees("Another fault for B1.7", "moved to a folder")
        await me.press("enter")
        await me.until(lambda: session.handed_over.drawn(lesson).current != first, "another one is drawn")
        await me.sees("Another fault is handed over")
        assert not me.main.nodes.running
        assert me.main.model.findings["b1.7"] == Findings.of(lesson)
        assert read_report(report.read_text()).what == ""


async def test_the_code_of_a_system_that_is_handed_over_stays_closed(session: Session) -> None:
    session.start(session.course.find("i1.1"))
    async with open_app(session, (120, 36)) as me:
        await go_to_lesson(me, "i1.2")
        await me.press("s")
        await me.until(lambda: me.main.page == "code", "the code is shown")
        await go_to_lesson(me, "b1.7")
        await me.press("1", "s")
        await me.sees("4 to watch")
        assert me.main.page == "lesson"


async def test_other_exercises_have_nothing_to_answer(session: Session) -> None:
    session.start(session.course.find("i1.1"))
    async with open_app(session, (80, 24)) as me:
        await me.press("A", "N")
        await me.pilot.pause()
        assert me.app.screen is me.main
        await go_to_lesson(me, "b1.7")
        await me.press("A")
        await me.sees("courier_launch.py and 6 more files are not in your", "nothing to answer")


async def go_to_lesson(me: Any, id: str) -> None:
    await me.main.go_to(me.main.model.session.course.find(id))
    await me.until(lambda: me.main.model.lesson.id == id, id)
