"""What the app remembers in the workspace, and finding things by the palette."""

from __future__ import annotations

from typing import Any

from tests.tui import made
from tutor.tui.app import TutorApp


async def again(me: Any) -> Any:
    """The same workspace, opened once more; gives the state that the app begins with."""
    app = TutorApp(me.session)
    async with app.run_test(size=(120, 36)) as pilot:
        await made.opened(app, pilot)
        assert app.main is not None
        found = (app.main.model.lesson.id, app.main.page, app.theme, app.main.model.state)
        await app.main.close_down()
    return found


async def test_the_app_opens_where_it_was_left(learner: Any) -> None:
    async with learner() as me:
        await me.press("n", "t", "w", "F", "l", "2")
        await me.until(lambda: me.session.app_state().page == "code", "written")
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        lesson, page, theme, state = await again(me)
        assert (lesson, page, theme) == ("i1.3", "code", "ros-tutor-light")
        assert (state.check_on_save, state.restart_on_save, state.lessons_shown) == (True, False, False)
        assert state.first_failure


async def test_a_damaged_memory_is_set_aside_with_a_message(learner: Any) -> None:
    async with learner() as me:
        file = me.session.workspace.app_state(print).path
        file.write_text('{"schema": "ros-tutor/app/1", "lesson": 7}')
        told: list[str] = []
        me.session.notify = told.append
        assert me.session.app_state().lesson == ""
        assert "kept as" in told[0]
        assert len(list(file.parent.glob("app.json.damaged-*"))) == 1


async def test_the_palette_finds_a_line_of_a_lesson_and_goes_there(learner: Any) -> None:
    async with learner() as me:
        me.session.lessons[2].body.index("Publish random values")
        await me.press("ctrl+p", *"random")
        await me.sees("Publish random values from 20.0 to 30.0", "I2.3 Multi-Threaded Service, line")
        await me.press("up", "enter")
        await me.until(lambda: me.main.model.lesson.id == "i2.3", "gone there")
        await me.sees("I2.3  Multi-Threaded Service", "Publish random values")
        assert len(made.BODY.splitlines()) > 5
