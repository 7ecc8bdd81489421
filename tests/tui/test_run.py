"""Running the learner's node: a real process."""

from __future__ import annotations

import os
from typing import Any

import pytest

from tests.tui import made
from tutor.tui.node import Phase


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.parametrize("size", [(120, 36), (80, 24)])
async def test_the_log_of_a_running_node_is_shown_with_its_levels(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await me.press("r")
        await me.sees("running", "INFO", "ready", "WARN", "the sensor is warm", "print", "a printed line", "r Stop")
        assert me.text("#log-view").replace("\n        ", "").count("x") >= 200  # the long line is wrapped, not cut
        await me.press("r")
        await me.sees("ended", "stopped", "bye", "r Run")


async def test_a_node_that_ignores_ctrl_c_is_ended_all_the_same(learner: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tutor.tui.node.INTERRUPT_S", 0.2)
    async with learner() as me:
        me.desk.path(me.desk.lessons[0].files[0]).write_text(
            "import os\nprint(os.getpid(), flush=True)\n" + made.STUBBORN
        )
        await me.press("r")
        await me.sees("deaf")
        pid = int(me.node.state.lines[0].text)
        await me.press("r")
        await me.sees("ignored Ctrl+C")
        await me.until(lambda: not alive(pid))


async def test_a_node_that_breaks_shows_its_traceback_and_its_exit(learner: Any) -> None:
    async with learner() as me:
        me.desk.path(me.desk.lessons[0].files[0]).write_text("print('[not markup]')\nraise ValueError('wrong')\n")
        await me.press("r")
        await me.sees("[not markup]", "Traceback", "ValueError: wrong", "ended by itself with exit code 1")


async def test_a_flood_of_lines_leaves_the_app_usable(learner: Any) -> None:
    async with learner() as me:
        me.desk.path(me.desk.lessons[0].files[0]).write_text("n = 0\nwhile True:\n    n += 1\n    print('line', n)\n")
        await me.press("r")
        await me.until(lambda: me.node is not None and me.node.state.dropped > 0)
        await me.press("1")
        await me.sees("Objective")
        await me.press("r")
        await me.until(lambda: me.node.state.phase is Phase.ENDED)


async def test_the_node_runs_on_while_another_lesson_is_read_and_the_terminal_changes(learner: Any) -> None:
    async with learner() as me:
        await me.press("r")
        await me.sees("ready")
        await me.press("n")
        await me.pilot.resize_terminal(80, 24)
        await me.sees("I1.3", "running thermometer.py")
        await me.press("3")
        await me.sees("the sensor is warm")


async def test_quitting_ends_the_node(learner: Any) -> None:
    async with learner() as me:
        me.desk.path(me.desk.lessons[0].files[0]).write_text("import os\nprint(os.getpid(), flush=True)\n" + made.NODE)
        await me.press("r")
        await me.sees("ready")
        pid = int(next(line.text for line in me.node.state.lines if line.text.isdecimal()))
        assert alive(pid)
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        assert not alive(pid)
