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
from tutor.tui.terminal.prompt import Prompt


def output(me: Any) -> str:
    plain: str = me.main.query_one(OutputView).plain
    return plain


async def open_terminal(me: Any) -> None:
    await me.press("7")
    await me.sees("Your terminal", "Type a command")
    await me.until(lambda: isinstance(me.app.focused, Prompt), "the prompt has the focus")


async def test_a_typed_command_prints_its_output_below(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        await me.type_text("echo out; echo err >&2; exit 3\n")
        await me.sees("1 echo out; echo err >&2", "[exit code 3]")
        assert {"out", "err"} <= set(output(me).splitlines())


async def test_several_commands_run_at_once_and_ctrl_c_stops_the_one_that_is_shown(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        await me.type_text("echo first $$; exec sleep 600\n")
        await me.until(lambda: "first" in output(me).replace("echo first", ""))
        first = int(output(me).split()[-1])
        await me.type_text("echo second $$; exec sleep 600\n")
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


async def test_quitting_the_app_ends_its_commands(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        await me.type_text("echo $$; sleep 600 & sleep 600\n")
        await me.until(lambda: output(me).splitlines()[-1].isdecimal())
        pid = int(output(me).splitlines()[-1])
        assert me.main.busy
        await me.main.close_down()
        assert not is_alive(pid)


async def test_history_goes_back_and_returns_to_the_unfinished_line(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        await me.type_text("echo one\n")
        await me.type_text("echo two\n")
        await me.type_text("ech")
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
        await me.main.close_down()
        assert me.session.typed_commands() == ["echo one", "echo two"]


async def test_tab_completes_programs_and_paths(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        prompt = me.main.query_one(Prompt)
        await me.type_text("pyt")
        await me.press("tab")
        await me.until(lambda: prompt.value == "python3 ")
        await me.type_text("sr")
        await me.press("tab")
        await me.until(lambda: prompt.value == "python3 src/")
        await me.press("tab")
        await me.until(lambda: prompt.value == "python3 src/my_package/")


async def test_keys_typed_ahead_keep_their_order(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        prompt = me.main.query_one(Prompt)
        await me.press(*"bc", "home", "a", "end", "d", "left", "left", "left", "delete", "x", "ctrl+e", "e")
        await me.until(lambda: prompt.value == "axcde", prompt.value)


async def test_cd_and_export_persist(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        await me.type_text("cd src\n")
        await me.type_text("export WHERE=here\n")
        await me.type_text("basename $PWD; echo $WHERE\n")
        await me.until(lambda: output(me).splitlines()[-2:] == ["src", "here"])
        await me.type_text("cd nowhere\n")
        await me.sees("cd: nowhere: No such file or directory")


async def test_after_escape_from_the_prompt_the_keys_of_the_app_work_again(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        await me.type_text("echo here\n")
        await me.until(lambda: output(me).splitlines()[-1:] == ["here"])
        await me.press("escape")
        await me.until(lambda: isinstance(me.app.focused, OutputView))
        await me.press("1")
        await me.sees("temperature sensor")


async def test_program_output_is_plain_text(learner: Any) -> None:
    async with learner() as me:
        await open_terminal(me)
        await me.type_text("printf '[b]\\033[31mred\\033[0m \\033]0;title\\007end\\n'\n")
        await me.until(lambda: "[b]red end" in output(me).splitlines())


async def test_a_lesson_command_is_run_by_key_and_by_click(learner: Any, monkeypatch: Any) -> None:
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
