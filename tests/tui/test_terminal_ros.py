"""The terminal page with real nodes, as a learner of i2.1 uses it."""

from __future__ import annotations

import re
from pathlib import Path

from tests.tui.conftest import Learner, open_app
from tutor.content import load_course
from tutor.session import Session
from tutor.tui.terminal.output_view import OutputView
from tutor.tui.terminal.prompt import Prompt
from tutor.workspace import Workspace, start


def rates(me: Learner) -> list[float]:
    text = me.main.query_one(OutputView).plain
    return [float(rate) for rate in re.findall(r"average rate: ([\d.]+)", text)]


async def test_a_rate_set_in_the_terminal_is_measured_there(tmp_path: Path) -> None:
    """Start the solution of i2.1, watch its rate, set it in a second command, see it change, press Ctrl+C."""
    course = load_course()
    lesson = next(lesson for lesson in course.lessons if lesson.id == "i2.1")
    workspace = Workspace(tmp_path / "ws")
    start(lesson, workspace)
    file = lesson.files[0]
    workspace.path_of(file.name).write_bytes(file.solution.read_bytes())
    async with open_app(Session(course, workspace)) as me:
        me.limit_s = 60.0  # type: ignore[misc]  # real nodes, on a machine that may be busy
        await me.main.go_to(lesson)
        await me.press("f5")
        await me.sees("running", file.name)
        await me.press("f10")
        await me.until(lambda: isinstance(me.app.focused, Prompt), "the prompt has the focus")
        await me.type_text("ros2 topic hz /chatter --window 8\n")
        await me.until(lambda: bool(rates(me)) and abs(rates(me)[-1] - 1.0) < 0.3, "about 1 Hz")
        await me.type_text("ros2 param set /parameterized_publisher publish_rate 10.0\n")
        await me.sees("Set parameter successful")
        await me.press("ctrl+pagedown")
        await me.until(lambda: bool(rates(me)) and abs(rates(me)[-1] - 10.0) < 3.0, "about 10 Hz")
        await me.press("ctrl+c")
        terminal = me.main.pages.terminal
        assert terminal is not None
        await me.until(lambda: not terminal.running, "the command has ended")
        assert "Traceback" not in me.main.query_one(OutputView).plain


async def test_tab_completes_topic_names(tmp_path: Path) -> None:
    course = load_course()
    workspace = Workspace(tmp_path / "ws")
    start(course.lessons[0], workspace)
    async with open_app(Session(course, workspace)) as me:
        me.limit_s = 60.0  # type: ignore[misc]  # completion queries the ROS domain
        await me.press("f10")
        prompt = me.main.query_one(Prompt)
        await me.until(lambda: me.app.focused is prompt)
        await me.type_text("ros2 topic pu")
        await me.press("tab")
        await me.until(lambda: prompt.value == "ros2 topic pub ", prompt.value)
        await me.type_text("/ros")
        await me.press("tab")
        await me.until(lambda: prompt.value == "ros2 topic pub /rosout ", prompt.value)
