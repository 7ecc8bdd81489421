"""The terminal page with real nodes, as a learner of i2.1 uses it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.tui.conftest import Learner, open_app
from tutor.content import load_course
from tutor.session import Session
from tutor.tui.terminal.view import TerminalView
from tutor.workspace import Workspace, start

PROMPT = "(ROS 2: ws)"


def shown(me: Learner) -> TerminalView:
    assert me.main.pages.terminal is not None
    view = me.main.pages.terminal.shown
    assert view is not None
    return view


def text(me: Learner) -> str:
    return shown(me).plain


def rates(me: Learner) -> list[float]:
    return [float(rate) for rate in re.findall(r"average rate: ([\d.]+)", text(me))]


async def enter(me: Learner, command: str) -> None:
    """Paste a command at the prompt, and press Enter."""
    await me.until(lambda: (program := shown(me).program) is not None and program.reads_keys, "the prompt")
    me.paste(command)
    await me.press("enter")


async def test_two_terminals_share_the_apps_domain_and_ctrl_c_ends_an_echo(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Run the solution of i2.1, watch its rate, set it in a second terminal, see it change; then echo, and complete."""
    monkeypatch.setenv("SHELL", "/bin/bash")
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
        await me.sees(PROMPT)
        await enter(me, "ros2 topic hz /chatter --window 8")
        await me.until(lambda: bool(rates(me)) and abs(rates(me)[-1] - 1.0) < 0.3, "about 1 Hz")
        await me.press("ctrl+right_square_bracket", "plus")
        await me.sees("2 bash")
        await enter(me, "ros2 param set /parameterized_publisher publish_rate 10.0")
        await me.sees("Set parameter successful")
        await me.press("ctrl+right_square_bracket", "1")
        await me.until(lambda: bool(rates(me)) and abs(rates(me)[-1] - 10.0) < 3.0, "about 10 Hz")
        await me.press("ctrl+c")
        await enter(me, "clear; ros2 topic echo /chatter")
        await me.until(lambda: "data: 'Hello #" in text(me) and "---" in text(me), "messages")
        assert me.main.busy
        await me.press("ctrl+c")
        await enter(me, "clear")
        assert "Traceback" not in text(me)
        await me.until(lambda: not me.main.pages.terminal.busy, "the echo has ended")  # type: ignore[union-attr]

        # Tab completes what there is in the domain.
        await me.type_text("ros2 topic pu\t")
        await me.sees("ros2 topic pub ")
        await me.type_text("/cha\t")
        await me.sees("ros2 topic pub /chatter ")
