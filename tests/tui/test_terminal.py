"""The terminal page as a learner uses it: their own shell, with real processes."""

from __future__ import annotations

import asyncio
import os
import shutil
import sys
from pathlib import Path
from typing import Any

from tests.benchmarks.terminal import Terminal
from tests.tui import fakes
from tests.tui.conftest import is_alive
from tutor import run_module
from tutor.content import load_course
from tutor.tui.terminal.foreground import describe
from tutor.tui.terminal.pane import TerminalPane
from tutor.tui.terminal.view import TerminalView
from tutor.tui.widgets.strip import TabStrip
from tutor.workspace import Workspace, start

PROMPT = "(ROS 2: ws)"


def shown(me: Any) -> TerminalView:
    view = me.main.query_one(TerminalPane).shown
    assert isinstance(view, TerminalView)
    return view


def lines(me: Any) -> list[str]:
    return [line.strip() for line in shown(me).plain.splitlines()]


async def at_prompt(me: Any) -> None:
    await me.until(
        lambda: (program := shown(me).program) is not None and program.reads_keys, "the shell is at its prompt"
    )
    await me.until(lambda: shown(me).has_focus, "the terminal has the focus")


async def open_terminal(me: Any) -> None:
    await me.press("7")
    await me.until(lambda: me.main.pages.terminal is not None and me.main.pages.terminal.shown is not None)
    await at_prompt(me)


async def enter(me: Any, command: str) -> None:
    """Paste a command, and press Enter."""
    me.paste(command)
    await me.press("enter")


async def prints(me: Any, line: str) -> None:
    await me.until(lambda: line in lines(me), f"a line {line!r}")


async def test_it_is_a_shell_that_remembers_and_whose_programs_read_keys(learner: Any) -> None:
    async with learner((80, 24)) as me:
        await open_terminal(me)
        await me.sees(PROMPT, "1 bash", "Ctrl+] or an F key leaves")
        await enter(me, "cd src; export WHERE=here")
        await at_prompt(me)
        await enter(me, "basename $PWD; echo $WHERE; echo $ROS_TUTOR_WORKSPACE | wc -w")
        await prints(me, "src")
        await prints(me, "here")
        await prints(me, "1")

        # Letters that are commands of the app, and its control keys, all go to the program.
        await me.type_text("read line; echo got $line\n")
        await me.until(lambda: not shown(me).program.reads_keys)  # type: ignore[union-attr]
        await me.type_text("qcr7?h n\n")
        await prints(me, "got qcr7?h n")
        assert me.main.page == "terminal"
        await me.press("ctrl+p", "ctrl+p", "ctrl+p", "enter")  # history; elsewhere Ctrl+P opens the palette
        await me.until(lambda: lines(me).count("src") == 1 and len(me.app.screen_stack) == 2)
        await me.press("ctrl+q")
        await me.type_text("echo stay\n")
        await prints(me, "stay")

        # Ctrl+C, Ctrl+D, Tab.
        await enter(me, "sleep 600")
        await me.sees("1 sleep 600")
        assert me.main.busy
        await me.press("ctrl+c")
        await at_prompt(me)
        assert not me.main.busy
        await me.type_text("cd my_pa\t\n")
        await at_prompt(me)
        await enter(me, "echo in ${PWD##*/}")
        await prints(me, "in my_package")
        await me.press("ctrl+d")
        await me.sees("No terminal is open.")
        await me.press("enter")
        await at_prompt(me)


async def test_several_terminals_are_opened_shown_and_closed_by_keys(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        await enter(me, "echo pid $$; sleep 600")
        await me.until(lambda: any(line.startswith("pid") for line in lines(me)))
        first = next(int(line.split()[1]) for line in lines(me) if line.startswith("pid"))
        await me.press("ctrl+right_square_bracket")
        await me.until(lambda: isinstance(me.app.focused, TabStrip))
        await me.sees("1-9 shows", "+ new", "- close")
        await me.press("plus")
        await at_prompt(me)
        await me.sees("1 sleep 600", "2 bash")
        await enter(me, "echo second")
        await prints(me, "second")
        await me.press("ctrl+right_square_bracket", "1")
        await me.until(lambda: shown(me).id == "terminal-1" and shown(me).has_focus)
        await me.press("ctrl+right_square_bracket", "right", "enter")
        await me.until(lambda: shown(me).id == "terminal-2" and shown(me).has_focus)
        assert "second" in lines(me)

        await me.press("ctrl+right_square_bracket", "1")
        await me.press("ctrl+right_square_bracket", "minus")
        await me.until(lambda: not is_alive(first))
        await me.sees_no("1 sleep")
        await me.until(lambda: shown(me).id == "terminal-2")

        # An F key leads to a page at once; the terminal goes on meanwhile.
        await me.press("enter")
        await at_prompt(me)
        await enter(me, "for i in 1 2 3; do echo out $i; done; echo $$ > pid; sleep 600")
        await me.press("f2")
        await me.sees("temperature sensor")
        await me.press("7")
        await prints(me, "out 3")
        pid = int((me.session.workspace.root / "pid").read_text())
        await me.app.close_down()
        assert not is_alive(pid)


async def test_a_lesson_command_is_typed_by_key_and_click_into_a_terminal_that_is_free(
    learner: Any, monkeypatch: Any
) -> None:
    body = fakes.BODY + "\n```bash\nexpr 40 + \\\n    2   # shown\nsleep 600\n```\n"
    monkeypatch.setattr(fakes, "BODY", body)
    async with learner() as me:
        await me.press("R")
        await me.sees("Run a command of the lesson", "expr 40 + 2", "sleep 600")
        await me.press("enter")
        await me.until(lambda: me.main.pages.terminal is not None and me.main.pages.terminal.shown is not None)
        await prints(me, "42")
        assert any(line.endswith("$ expr 40 + 2") for line in lines(me))

        await me.press("f2")
        await me.sees("sleep 600")
        row, line = next((y, line) for y, line in enumerate(me.screen().splitlines()) if "sleep 600" in line)
        await me.pilot.click(offset=(line.index("sleep 600") + 2, row))
        await me.sees("1 sleep 600")

        # The first terminal is busy: another one is opened. A line that was begun there is taken back.
        await me.press("f2", "R", "enter")
        await me.until(lambda: shown(me).id == "terminal-2")
        await prints(me, "42")
        await at_prompt(me)
        await me.type_text("echo half")
        await me.press("f2", "R", "enter")
        await me.until(lambda: lines(me).count("42") == 2)
        assert "half" not in [line for line in lines(me) if line.startswith("half")]


async def test_a_resize_a_full_screen_program_the_history_and_a_paste(learner: Any) -> None:
    async with learner((120, 36)) as me:
        await open_terminal(me)
        await enter(me, "trap 'echo size $(stty size)' WINCH; stty size")
        await at_prompt(me)
        size = shown(me).size
        await prints(me, f"{size.height} {size.width}")
        await me.pilot.resize_terminal(100, 30)
        await me.until(lambda: shown(me).size != size and shown(me).size.width > 20)
        size = shown(me).size
        await enter(me, "clear; stty size")
        await prints(me, f"{size.height} {size.width}")

        await enter(me, "clear; seq 1 300")
        await prints(me, "300")
        await me.press("shift+pageup", "shift+pageup")
        await me.sees("more rows below")
        assert "300" not in lines(me)
        await me.press("x", "backspace")
        await me.until(lambda: "300" in lines(me))
        await me.pilot._post_mouse_events([_wheel_up(me)], shown(me))
        await me.sees("3 more rows below")
        await me.press("space")

        # A paste of several lines is typed, and run only by Enter.
        await enter(me, "clear")
        await at_prompt(me)
        me.paste("echo one\necho two")
        await me.sees("echo two")
        assert "one" not in lines(me)
        await me.press("enter")
        await prints(me, "two")

        if shutil.which("less"):
            await enter(me, "clear; seq 1 300 | less")
            await prints(me, "1")
            await me.press("G")
            await prints(me, "300")
            await me.press("q")
            await at_prompt(me)
            await me.until(lambda: "300" not in lines(me))


def _wheel_up(me: Any) -> type:
    from textual.events import MouseScrollUp

    return MouseScrollUp


async def test_what_a_program_writes_can_neither_leave_the_page_nor_reach_the_apps_keys(
    learner: Any, monkeypatch: Any
) -> None:
    async with learner((80, 24)) as me:
        copied: list[str] = []
        monkeypatch.setattr(me.app, "copy_to_clipboard", copied.append)
        await open_terminal(me)
        attack = me.session.workspace.root / "attack"
        attack.write_bytes(
            b"\x1b]52;c;aGVsbG8=\x07\x1b]0;title\x07\x07\x07\x1b[2;2H\x1b[?1003h\x1b[?25l[b]bold[/b]\x1b[?1003l\x1b[?25h"
            b"\x1b[c\x1b[6n\x1bc\x1b[31mred\x1b[0m end\n"
        )
        await enter(me, "clear; cat attack")
        await me.until(lambda: any("red end" in line for line in lines(me)))
        await me.press("ctrl+u")
        await enter(me, "echo still here")
        await prints(me, "still here")
        assert copied == []
        assert me.app.title == "ROS Tutor"
        assert me.main.page == "terminal"


def test_no_escape_sequence_of_a_program_gets_to_the_real_terminal(tmp_path: Path) -> None:
    lesson = load_course().lessons[0]
    workspace = Workspace(tmp_path / "ws")
    start(lesson, workspace)
    marks = [b"]52;c;aGVsbG8", b"]0;stolen", b"]9;stolen", b"[5i", b"\x07", b"P1;1|17"]
    (workspace.root / "attack").write_bytes(
        b"\x1b]52;c;aGVsbG8=\x07\x1b]0;stolen\x07\x1b]9;stolen\x07\x1b[5i\x07\x1bP1;1|17/ab\x1b\\\xc2\x9b31mthe end\n"
    )
    app = Terminal(
        [
            sys.executable,
            "-c",
            "import sys; from tutor.cli import main; sys.exit(main())",
            "--workspace",
            str(workspace.root),
        ],
        dict(os.environ),
    )
    try:
        app.wait_for_text(b"Objective")
        app.press(b"7")
        app.wait_for_text(PROMPT.encode())
        app.press(b"cat attack\r")
        app.wait_for_text(b"the end")
        app.read(1.0)
        seen = app._seen
        assert not [mark for mark in marks if mark in seen]
    finally:
        app.press(b"\x1d")  # Ctrl+]; then Ctrl+Q is for the app again
        app.wait_for_text(b"1-9 shows")
        app.close()


async def test_the_page_costs_nothing_until_it_is_opened(learner: Any) -> None:
    code = "import sys, tutor.tui.screens.main; print([m for m in ('pyghostty', 'cffi') if m in sys.modules])"
    process = await asyncio.create_subprocess_exec(sys.executable, "-c", code, stdout=asyncio.subprocess.PIPE)
    assert (await process.communicate())[0].strip() == b"[]"


def test_a_tab_says_what_runs() -> None:
    python = ["/usr/bin/python3.12", "-P", run_module.__file__, "tutor.bundled_ros.ros2", "topic", "echo", "/chatter"]
    assert describe(python) == "ros2 topic echo /chatter"
    assert describe(["-bash"]) == "bash"
    assert describe(["/bin/zsh", "-i"]) == "zsh"
    assert describe(["/usr/bin/python3", "/ws/src/node.py", "--ros-args"]) == "node.py --ros-args"
    assert describe([""]) == ""
