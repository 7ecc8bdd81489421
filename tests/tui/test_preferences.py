"""What the app remembers in the workspace."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tests.tui import fakes
from tutor.tui.app import TutorApp


async def reopen(me: Any) -> Any:
    """Open the app on the same workspace once more: the lesson id, page, theme and state with which it starts."""
    app = TutorApp(me.session)
    async with app.run_test(size=(80, 24)) as pilot:
        await fakes.wait_until_ready(app, pilot)
        assert app.main is not None
        start = (app.main.model.lesson.id, app.main.page, app.theme, app.main.model.state)
        await app.close_down()
    return start


async def test_the_app_opens_where_it_was_left(learner: Any) -> None:
    async with learner() as me:
        await me.press("n", "t", "w", "F", "l", "2")
        await me.until(lambda: me.session.app_state().page == "code", "saved")
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        lesson, page, theme, state = await reopen(me)
        assert (lesson, page, theme) == ("i1.3", "code", "ros-tutor-light")
        assert (state.check_on_save, state.restart_on_save, state.lessons_shown) == (True, False, False)
        assert state.first_failure


def test_damaged_app_state_is_set_aside_with_a_message(tmp_path: Path) -> None:
    session = fakes.FakeSession(tmp_path / "learner")
    file = session.workspace.app_state(print).path
    file.write_text('{"schema": "ros-tutor/app/1", "lesson": 7}')
    messages: list[str] = []
    session.notify = messages.append
    assert session.app_state().lesson == ""
    assert "kept as" in messages[0]
    assert len(list(file.parent.glob("app.json.damaged-*"))) == 1
