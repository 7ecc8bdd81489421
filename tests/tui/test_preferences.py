"""What the app remembers in the workspace, and finding text with the palette."""

from __future__ import annotations

from typing import Any

from tests.tui import fakes
from tutor.tui.app import TutorApp


async def reopen(me: Any) -> Any:
    """Open the app on the same workspace once more: the lesson id, page, theme and state with which it starts."""
    app = TutorApp(me.session)
    async with app.run_test(size=(120, 36)) as pilot:
        await fakes.wait_until_ready(app, pilot)
        assert app.main is not None
        start = (app.main.model.lesson.id, app.main.page, app.theme, app.main.model.state)
        await app.main.close_down()
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


async def test_damaged_app_state_is_set_aside_with_a_message(learner: Any) -> None:
    async with learner() as me:
        file = me.session.workspace.app_state(print).path
        file.write_text('{"schema": "ros-tutor/app/1", "lesson": 7}')
        messages: list[str] = []
        me.session.notify = messages.append
        assert me.session.app_state().lesson == ""
        assert "kept as" in messages[0]
        assert len(list(file.parent.glob("app.json.damaged-*"))) == 1


async def test_the_palette_finds_a_line_of_a_lesson_and_goes_there(learner: Any) -> None:
    async with learner() as me:
        me.session.lessons[2].body.index("Publish random values")
        await me.press("ctrl+p", *"random")
        await me.sees("Publish random values from 20.0 to 30.0", "I2.3 Multi-Threaded Service, line")
        await me.press("up", "enter")
        await me.until(lambda: me.main.model.lesson.id == "i2.3", "the lesson is open")
        await me.sees("I2.3  Multi-Threaded Service", "Publish random values")
        assert len(fakes.BODY.splitlines()) > 5
