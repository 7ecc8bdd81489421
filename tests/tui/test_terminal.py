"""The terminal page as a learner uses it, with real processes."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from tests.tui import fakes
from tests.tui.conftest import is_alive
from tutor import private_folders
from tutor.tui.terminal.completion import complete
from tutor.tui.terminal.output_view import OutputView
from tutor.tui.terminal.pane import TerminalPane
from tutor.tui.terminal.prompt import Prompt


def output(me: Any) -> str:
    plain: str = me.main.query_one(OutputView).plain
    return plain


async def open_terminal(me: Any) -> None:
    await me.press("7")
    await me.sees("Your terminal", "Type a command")
    await me.until(lambda: isinstance(me.app.focused, Prompt), "the prompt has the focus")


async def enter(me: Any, command: str) -> None:
    """Paste a command, and press Enter."""
    me.paste(command)
    await me.press("enter")


async def test_commands_print_their_output_below_and_share_a_shell_and_a_history(learner: Any) -> None:
    async with learner((80, 24)) as me:
        await open_terminal(me)
        await me.type_text("echo one\n")
        await enter(me, "echo two")
        await me.type_text("ech")

        # The history goes back, and returns to the unfinished line.
        prompt = me.main.query_one(Prompt)
        for key, text in (
            ("up", "echo two"),
            ("up", "echo one"),
            ("up", "echo one"),
            ("down", "echo two"),
            ("down", "ech"),
        ):
            await me.press(key)
            await me.until(lambda text=text: prompt.value == text, text)
        await me.press("ctrl+c")
        await me.until(lambda: not prompt.value)

        await enter(me, "echo out; echo err >&2; exit 3")
        await me.sees("3 echo out; echo err >&2", "[exit code 3]")
        assert {"out", "err"} <= set(output(me).splitlines())

        # What a program prints is plain text.
        await enter(me, "printf '[b]\\033[31mred\\033[0m \\033]0;title\\007end\\n'")
        await me.until(lambda: "[b]red end" in output(me).splitlines())

        # `cd` and `export` last.
        await enter(me, "cd src")
        await enter(me, "export WHERE=here")
        await enter(me, "basename $PWD; echo $WHERE")
        await me.until(lambda: output(me).splitlines()[-2:] == ["src", "here"])
        await enter(me, "cd nowhere")
        await me.sees("cd: nowhere: No such file or directory")

        # An error stays when the command above it ends, and leaves with the next line.
        await enter(me, "echo go; read line; echo ended")
        await me.until(lambda: output(me).splitlines()[-1:] == ["go"])
        await enter(me, "cd nowhere")
        await me.sees("cd: nowhere")
        me.main.query_one(TerminalPane).running[0].stop()
        await me.sees("■ 6 echo go", "cd: nowhere: No such file or directory")
        await enter(me, "cd .")
        await me.sees_no("cd: nowhere")
        await enter(me, "cd nowhere")
        await me.sees("cd: nowhere")

        await me.main.close_down()
        commands = me.session.typed_commands()
        assert commands[:3] == ["echo one", "echo two", "echo out; echo err >&2; exit 3"]
        assert commands[-1] == "cd nowhere"


async def test_several_commands_run_at_once_ctrl_c_stops_the_one_shown_and_quitting_the_others(learner: Any) -> None:
    async with learner((80, 24)) as me:
        await open_terminal(me)
        await enter(me, "echo first $$; exec sleep 600")
        await me.until(lambda: "first" in output(me).replace("echo first", ""))
        first = int(output(me).split()[-1])
        await enter(me, "echo second $$; exec sleep 600")
        await me.until(lambda: "second" in output(me).replace("echo second", ""))
        second = int(output(me).split()[-1])
        assert is_alive(first)
        assert is_alive(second)
        await me.press("ctrl+c")
        await me.until(lambda: not is_alive(second))
        await me.sees("■ 2 echo second")  # it was stopped, which is not a failure
        assert is_alive(first)
        await me.press("ctrl+pagedown")
        await me.until(lambda: "first" in output(me))
        await me.press("ctrl+c")
        await me.until(lambda: not is_alive(first))
        await me.sees("Terminal")

        await enter(me, "echo $$; sleep 600 & sleep 600")
        await me.until(lambda: output(me).splitlines()[-1].isdecimal())
        pid = int(output(me).splitlines()[-1])
        assert me.main.busy
        await me.main.close_down()
        assert not is_alive(pid)


async def test_a_lesson_command_is_run_by_key_and_click_and_the_prompt_completes_in_order(
    learner: Any, monkeypatch: Any
) -> None:
    body = fakes.BODY + "\n```bash\necho by \\\n    key   # shown\necho by click\n```\n"
    monkeypatch.setattr(fakes, "BODY", body)
    async with learner() as me:
        await me.press("R")
        await me.sees("Run a command of the lesson", "echo by key", "echo by click")
        await me.press("enter")
        await me.until(lambda: output(me).splitlines()[-1:] == ["by key"])
        await me.press("f2")
        await me.sees("echo by click")
        row, line = next((y, line) for y, line in enumerate(me.screen().splitlines()) if "echo by click" in line)
        await me.pilot.click(offset=(line.index("echo by click") + 2, row))
        await me.until(lambda: output(me).splitlines()[-1:] == ["by click"])

        # Keys typed ahead keep their order, and Tab completes programs and paths.
        await me.until(lambda: isinstance(me.app.focused, Prompt), "the prompt has the focus")
        prompt = me.main.query_one(Prompt)
        await me.press(*"bc", "home", "a", "end", "d", "left", "left", "left", "delete", "x", "ctrl+e", "e")
        await me.until(lambda: prompt.value == "axcde", prompt.value)
        await me.press("ctrl+u", *"pyt", "tab")
        await me.until(lambda: prompt.value == "python3 ")
        await me.press(*"sr", "tab")
        await me.until(lambda: prompt.value == "python3 src/")
        await me.press("tab")
        await me.until(lambda: prompt.value == "python3 src/my_package/")

        # After Esc, the keys of the app work again.
        await me.press("escape")
        await me.until(lambda: isinstance(me.app.focused, OutputView))
        await me.press("1")
        await me.sees("temperature sensor")


async def test_completion_files_are_where_the_files_of_a_killed_app_are_swept(tmp_path: Path) -> None:
    where = tmp_path / "where"
    program = tmp_path / "ros2"
    program.write_text(f'#!/bin/sh\nprintf %s "$_ARGCOMPLETE_STDOUT_FILENAME" > {where}\n')
    program.chmod(0o755)
    env = {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
    await complete("ros2 topic ", 11, env, tmp_path)
    folder = Path(where.read_text()).parent
    assert folder.parent == private_folders.base()
    assert folder.name.startswith("complete.")  # like everything that `private_folders` removes
    assert not folder.exists()
