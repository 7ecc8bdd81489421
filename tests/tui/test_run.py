"""Running the learner's node, as a real process."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from tests.tui import fakes
from tests.tui.conftest import is_alive
from tutor.session.node import Phase
from tutor.tui.widgets.line_view import Row
from tutor.tui.widgets.log_view import _wrapped

ECHO = "import os, sys\nprint('given', *sys.argv[1:], flush=True)\nprint('pid', os.getpid(), flush=True)\n"

CRASHES = """\
import sys
for number in range(60):
    print("line", number, flush=True)
def tick(depth):
    tick(depth - 1) if depth else int("no number")
sys.setrecursionlimit(400)
tick(12)
"""


@pytest.mark.parametrize("size", [(120, 36), (80, 24)])
async def test_the_log_of_a_running_node_is_shown_with_its_levels_and_followed(learner: Any, size: Any) -> None:
    async with learner(size) as me:
        await me.press("r")
        await me.sees("running", "INFO", "ready", "WARN", "the sensor is warm", "print", "a printed line", "r Stop")
        # The long line is wrapped, not cut.
        await me.until(lambda: me.text("#log-view").replace("\n        ", "").count("x") >= 200, "the long line")
        await me.press("r")
        await me.sees("ended", "stopped", "bye", "r Run")

        # After a crash, the last line of the exception is visible.
        await me.runs(CRASHES)
        await me.sees("following", "ValueError: invalid literal", "ended by itself with exit code 1")

        # A log that fills while its page is hidden is still followed.
        go = me.file.with_name("go")
        await me.runs(f"import os, time\nwhile not os.path.exists({str(go)!r}):\n    time.sleep(0.05)\n" + CRASHES)
        await me.sees("● running")
        await me.press("1")
        await me.sees("Objective")
        go.touch()
        await me.until(lambda: me.node.state.phase is Phase.ENDED)
        await me.pilot.pause()
        await me.press("3")
        await me.sees("following", "ValueError: invalid literal", "ended by itself with exit code 1")
        await me.press("home")
        await me.sees("scrolled up: End follows", "line 0")
        await me.press("1", "3")
        await me.sees("scrolled up: End follows", "line 0")
        await me.press("end")
        await me.sees("following", "ValueError: invalid literal")


async def test_a_node_that_takes_time_to_start_does_not_take_the_learner_from_another_page(
    learner: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with learner() as me:
        make_command, go = me.session.node_command, threading.Event()

        def make_command_later(*given: Any) -> Any:
            go.wait(30.0)
            return make_command(*given)

        monkeypatch.setattr(type(me.session), "node_command", lambda _, *given: make_command_later(*given))
        await me.press("r")
        await me.until(lambda: me.main.page == "log")
        await me.press("2")
        await me.until(lambda: me.main.page == "code")
        go.set()
        await me.sees("● running")
        assert me.main.page == "code"


async def test_a_node_that_crashes_floods_the_log_or_ignores_ctrl_c(
    learner: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tutor.session.node.INTERRUPT_S", 0.2)
    async with learner() as me:
        # Its traceback leads to its lines in the editor.
        await me.runs("def tick():\n    raise ValueError('wrong')\n\nprint('[not markup]', flush=True)\ntick()\n")
        await me.sees("[not markup]", "Traceback", "ValueError: wrong", "ended by itself with exit code 1")
        await me.sees("← g or click")
        await me.press("g")
        await me.until(lambda: me.main.page == "code" and me.editor.cursor_location == (1, 4), "the raise")
        await me.press("escape", "3")
        row = next(n for n, line in enumerate(me.text("#log-view").split("\n")) if "line 5" in line)
        await me.pilot.click("#log-view", offset=(20, row))
        await me.until(lambda: me.main.page == "code" and me.editor.cursor_location == (4, 0), "the call")
        assert me.app.focused is me.editor
        await me.press("escape")

        # A flood of lines leaves the app usable.
        node = await me.runs("n = 0\nwhile True:\n    n += 1\n    print('line', n)\n")
        await me.until(lambda: node.state.dropped > 0)
        await me.press("1")
        await me.sees("Objective")
        await me.press("r")
        await me.until(lambda: node.state.phase is Phase.ENDED)

        node = await me.runs("import os\nprint(os.getpid(), flush=True)\n" + fakes.STUBBORN)
        await me.sees("deaf")
        pid = int(node.state.lines[0].text)
        await me.press("r")
        await me.sees("ignored Ctrl+C")
        await me.until(lambda: not is_alive(pid))

        # Quitting ends a node.
        node = await me.runs(ECHO + fakes.NODE)
        await me.sees("ready")
        pid = int(next(line.text for line in node.state.lines if line.text.startswith("pid ")).split()[1])
        assert is_alive(pid)
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        assert not is_alive(pid)


async def test_a_node_runs_with_options_and_keeps_running_while_another_lesson_is_open(learner: Any) -> None:
    async with learner() as me:
        me.file.write_text(ECHO + fakes.NODE)
        await me.press("o")
        await me.press(*"rate 5")
        await me.sees("'rate 5' sets no parameter: write name:=value", "F5 runs")
        await me.press("f5")
        await me.sees("sets no parameter")
        me.app.screen.query_one("#run-parameters").text = "rate:=5.0"
        me.app.screen.query_one("#run-remaps").text = "chatter:=/news"
        await me.sees("ros2 run my_package thermometer --ros-args -p rate:=5.0 -r", "chatter:=/news")
        await me.press("f5")
        await me.sees("given --ros-args -p rate:=5.0 -r chatter:=/news", "$       ros2 run my_package thermometer")
        await me.until(lambda: me.session.app_state().run_of("i1.1").parameters == ("rate:=5.0",), "remembered")

        await me.press("n")
        await me.pilot.resize_terminal(80, 24)
        await me.sees("I1.3", "● running")
        await me.press("3")
        await me.sees("the sensor is warm")


async def test_the_log_is_filtered_paused_and_cleared_and_a_save_restarts_the_node(learner: Any) -> None:
    async with learner() as me:
        await me.press("r")
        await me.sees("the sensor is warm", "a printed line", "a long line")
        await me.press("m", "m")
        await me.sees("WARN and above", "1 of 4 lines", "the sensor is warm")
        assert "a printed line" not in me.screen()
        await me.press("m", "m", "slash", *"print", "enter")
        await me.sees("a printed line", "'print'", "1 of 4 lines")
        assert "sensor is warm" not in me.screen()
        await me.press("escape")
        await me.sees("the sensor is warm")
        await me.press("space", "r")
        await me.sees("paused: go on", "ended")
        assert "bye" not in me.text("#log-view")
        await me.press("space")
        await me.until(lambda: "bye" in me.text("#log-view"))
        await me.press("C")
        await me.sees("0 of 5 lines")

        await me.press("W")
        await me.sees("a save restarts")
        before = await me.runs()
        await me.sees("the sensor is warm")
        await me.focus_editor()
        await me.press("end", "#", "ctrl+s")
        await me.until(lambda: me.node is not before and me.node.state.phase is Phase.RUNNING, "restarted")
        assert before.over.is_set()

        await me.sees("the sensor is warm")

        # A change from outside restarts it, too, and leaves the focus in the editor.
        saved = me.node
        await me.focus_editor()
        me.file.write_text(ECHO + fakes.NODE)
        await me.until(lambda: me.node is not saved and me.node.state.phase is Phase.RUNNING, "restarted")
        await me.until(lambda: any("pid" in line.text for line in me.node.state.lines), "output of the new file")
        assert me.main.page == "code"
        assert me.app.focused is me.editor
        await me.press("escape", "1")
        me.file.write_text(fakes.NODE)
        await me.sees("the sensor is warm")


async def test_a_server_and_its_client_run_side_by_side(learner: Any) -> None:
    async with learner() as me:
        await me.press("n", "s")
        await me.sees("server.py and client.py")
        await me.press("f5")
        await me.sees("● running  server.py", "the sensor is warm")
        await me.press("f")
        await me.sees("client.py")
        await me.press("r")
        await me.sees("● running  client.py", "running server.py and client.py")
        client = me.main.nodes.by_path[me.file]
        await me.until(lambda: len(client.state.lines) == 4, "what the client says at its start")
        await me.press("r")
        await me.sees("■ ended  client.py", "running server.py")


def test_the_hint_after_a_traceback_line_is_never_wrapped() -> None:
    for length in range(1, 240):
        line: Row = ((" stderr ", "warn"), ("x" * length, "link"), ("  ← g or click", "quiet"))
        rows = ["".join(text for text, _ in row) for row in _wrapped(line, 80)]
        assert any("← g or click" in row for row in rows)
        assert all(len(row) <= 80 for row in rows)
        assert sum(row.count("x") for row in rows) == length
