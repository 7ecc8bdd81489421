"""Starting an exercise, hints, the solution, the editor."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.tui import fakes


async def test_start_copies_the_skeleton_and_shows_it(learner: Any) -> None:
    async with learner() as me:
        await me.press("n", "2")
        await me.sees("server.py is not in your workspace yet")
        await me.press("s")
        await me.sees("is in your")
        await me.sees("1  import signal")
        await me.until(lambda: "started" in me.screen().partition("Calculator Service")[2])


async def test_a_file_created_by_hand_counts_as_started(learner: Any) -> None:
    async with learner() as me:
        lesson = me.session.lessons[1]
        assert "new" in me.screen().partition("Calculator Service")[2]
        me.session.path(lesson.files[0]).write_text("mine = 1\n")
        assert me.session.states(me.session.progress())[lesson.id].is_started
        me.main.records.read()
        await me.until(lambda: "started" in me.screen().partition("Calculator Service")[2])


async def test_start_never_touches_an_existing_file(learner: Any) -> None:
    async with learner() as me:
        path: Path = me.session.path(me.session.lessons[0].files[0])
        path.write_text("mine = 1\n")
        await me.press("s")
        await me.sees("already exists")
        assert path.read_text() == "mine = 1\n"


@pytest.mark.parametrize("key", ["r", "c", "e", "E"])
async def test_if_the_file_is_missing_the_app_offers_to_start_the_exercise(learner: Any, key: str) -> None:
    async with learner() as me:
        await me.press("n", key)
        await me.sees("server.py is not in your workspace yet, so there is", "Put the skeleton there?")
        await me.press("escape")
        assert not me.session.path(me.session.lessons[1].files[0]).exists()
        await me.press(key, "enter")
        await me.sees("1  import signal")
        assert me.session.path(me.session.lessons[1].files[0]).read_text() == fakes.NODE


async def test_hints_come_one_by_one_and_are_remembered(learner: Any) -> None:
    async with learner() as me:
        await me.press("h")
        await me.sees("hint 1 of 3", "Think of a timer.")
        assert "create_timer takes seconds." not in me.screen()
        await me.press("h")
        await me.sees("hint 2 of 3", "create_timer takes seconds.")
        await me.press("escape")
        await me.until(lambda: me.main.model.progress.of("i1.1").hints == 2)
        assert me.session.progress().of("i1.1").hints == 2
        await me.press("h")
        await me.sees("hint 2 of 3")


async def test_the_solution_is_shown_only_after_confirmation(learner: Any) -> None:
    async with learner() as me:
        await me.press("v")
        await me.sees("Show our solution all the same?")
        await me.press("escape")
        assert "# the solution" not in me.screen()
        await me.press("v", "enter")
        await me.sees("Our solution, read-only", "# the solution")
        await me.press("escape")
        await me.until(lambda: "# the solution" not in me.screen())


async def test_without_a_terminal_to_hand_over_the_outside_editor_is_refused_with_a_message(learner: Any) -> None:
    async with learner() as me:
        await me.press("E")
        await me.sees("cannot be handed")


async def test_damaged_progress_is_reported_and_set_aside(learner: Any) -> None:
    async with learner() as me:
        file = me.session.workspace.root / ".ros-tutor" / "progress.json"
        file.write_text("{ not json")
        me.main.records.read()
        await me.sees("could not")
        assert len(list(file.parent.glob("progress.json.damaged-*"))) == 1
