"""Starting an exercise, hints, the solution, the editor."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tests.tui import fakes
from tutor.workspace import Help


async def test_start_copies_the_skeleton_unless_the_file_exists(learner: Any) -> None:
    async with learner() as me:
        # A file created by hand counts as started.
        by_hand = me.session.lessons[2]
        assert "new" in me.screen().partition("Multi-Threaded")[2]
        me.session.path(by_hand.files[0]).write_text("mine = 1\n")
        assert me.session.states(me.session.progress())[by_hand.id].is_started
        me.main.records.read()
        await me.until(lambda: "started" in me.screen().partition("Multi-Threaded")[2])

        # An existing file is never touched.
        me.file.write_text("mine = 1\n")
        await me.press("s")
        await me.sees("already exists")
        assert me.file.read_text() == "mine = 1\n"

        assert "new" in me.screen().partition("Calculator Service")[2]
        await me.press("n", "2")
        await me.sees("server.py is not in your workspace yet")
        await me.press("s")
        await me.sees("are in your")
        await me.sees("1  import signal")
        await me.until(lambda: "started" in me.screen().partition("Calculator Service")[2].partition("I2.3")[0])


async def test_if_the_file_is_missing_the_app_offers_to_start_the_exercise(learner: Any) -> None:
    async with learner((80, 24)) as me:
        await me.press("n", "2")
        path: Path = me.session.path(me.session.lessons[1].files[0])
        for key in ("r", "c", "e", "E"):
            await me.sees("server.py is not in your workspace yet")
            await me.press(key)
            await me.sees("server.py is not in your workspace yet, so there is", "Put the skeleton there?")
            await me.press("escape")
            assert not path.exists()
            await me.press(key, "enter")
            await me.sees("1  import signal")
            assert path.read_text() == fakes.NODE
            path.unlink()  # noticed at once: the app has watched it since the start


async def test_hints_come_one_by_one_the_solution_is_confirmed_and_damaged_progress_set_aside(learner: Any) -> None:
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
        await me.press("escape")

        await me.press("v")
        await me.sees("Show our solution all the same?")
        await me.press("escape")
        assert "# the solution" not in me.screen()
        assert me.session.progress().of("i1.1").help is Help.HINTS
        await me.press("v", "enter")
        await me.sees("Our solution, read-only", "# the solution")
        await me.until(lambda: me.session.progress().of("i1.1").help is Help.SOLUTION, "saved")
        await me.press("escape")
        await me.until(lambda: "# the solution" not in me.screen())

        # Without a terminal to hand over, the editor outside is refused with a message.
        await me.press("E")
        await me.sees("cannot be handed")

        # Damaged progress is reported and set aside.
        file = me.session.workspace.root / ".ros-tutor" / "progress.json"
        file.write_text("{ not json")
        me.main.records.read()
        await me.sees("could not")
        assert len(list(file.parent.glob("progress.json.damaged-*"))) == 1
