"""The answer in plain lines: choices by their numbers, and another fault."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tutor.content import load_course
from tutor.content.cases import read_report
from tutor.errors import CommandRefused
from tutor.plain.answers import Answers
from tutor.plain.conversation import Conversation
from tutor.session import Session
from tutor.workspace import Workspace


def talk(session: Session, exercise: str, *typed: str) -> tuple[Answers, list[str]]:
    """The commands of an exercise, and what is said; `typed`: what the learner says when asked."""
    said: list[str] = []
    lines: Iterator[str] = iter(typed)

    async def ask(question: str) -> str | None:
        said.append(question)
        return next(lines, None)

    conversation = Conversation(session, said.append, ask)
    conversation.lesson = session.course.find(exercise)
    return Answers(conversation), said


@pytest.fixture
def session(tmp_path: Path) -> Session:
    return Session(load_course(), Workspace(tmp_path / "ws"))


async def test_an_answer_by_numbers(session: Session) -> None:
    session.start(session.course.find("b1.7"))
    answers, said = talk(session, "b1.7", "99", "3", "2")
    await answers.answer([])
    assert "1: the QoS of the two ends of a topic does not match." in said
    assert "There is no number 99." in said
    assert said[-1].endswith("where they belong, in courier_driver.py. check judges it.")
    report = read_report(session.workspace.path_of("courier_report.yaml").read_text())
    assert (report.what, report.where) == ("topic", "courier_driver.py")


async def test_no_answer_at_the_end_of_the_input(session: Session) -> None:
    session.start(session.course.find("b1.7"))
    answers, said = talk(session, "b1.7", "3")
    await answers.answer([])
    assert said[-1] == "Nothing is reported."


async def test_another_fault(session: Session) -> None:
    session.start(session.course.find("b1.7"))
    answers, said = talk(session, "b1.7")
    await answers.another([])
    assert "/handed-over/b1.7/1" in said[-2]
    assert said[-1] == "Another fault is handed over."


async def test_where_there_is_nothing_to_answer(session: Session) -> None:
    session.start(session.course.find("i1.1"))
    answers, _ = talk(session, "i1.1")
    for command in (answers.answer, answers.another):
        with pytest.raises(CommandRefused):
            await command([])
