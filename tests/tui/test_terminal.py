"""The terminal page, as a learner uses it; real processes."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from tests.tui import made
from tutor import private_folders
from tutor.tui.terminal.completion import complete
from tutor.tui.terminal.output_view import OutputView
from tutor.tui.terminal.prompt import Prompt


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def output(me: Any) -> str:
    found: str = me.main.query_one(OutputView).plain
    return found


async def opens_the_terminal(me: Any) -> None:
    await me.press("7")
    await me.sees("Your terminal", "Type a command")
    await me.until(lambda: isinstance(me.app.focused, Prompt), "the prompt has the focus")


async def test_a_command_is_typed_and_prints_below(learner: Any) -> None:
    async with learner() as me:
        await opens_the_terminal(me)
        await me.types("echo out; echo err >&2; exit 3\n")
        await me.sees("1 echo out; echo err >&2", "[exit code 3]")
        assert {"out", "err"} <= set(output(me).splitlines())


async def test_several_run_at_once_and_ctrl_c_stops_the_one_that_is_shown(learner: Any) -> None:
    async with learner() as me:
        await opens_the_terminal(me)
        await me.types("echo first $$; exec sleep 600\n")
        await me.until(lambda: "first" in output(me).replace("echo first", ""))
        first = int(output(me).split()[-1])
        await me.types("echo second $$; exec sleep 600\n")
        await me.until(lambda: "second" in output(me).replace("echo second", ""))
        second = int(output(me).split()[-1])
        assert alive(first)
        assert alive(second)
        await me.press("ctrl+c")
        await me.until(lambda: not alive(second))
        await me.sees("■ 2 echo second")  # it was stopped, which is not a failure
        assert alive(first)
        await me.press("ctrl+pagedown")
        await me.until(lambda: "first" in output(me))
        await me.press("ctrl+c")
        await me.until(lambda: not alive(first))
        await me.sees("Terminal")


async def test_leaving_the_app_ends_what_was_started(learner: Any) -> None:
    async with learner() as me:
        await opens_the_terminal(me)
        await me.types("echo $$; sleep 600 & sleep 600\n")
        await me.until(lambda: output(me).splitlines()[-1].isdecimal())
        pid = int(output(me).splitlines()[-1])
        assert me.main.busy
        await me.main.close_down()
        assert not alive(pid)


async def test_history_and_what_was_being_typed(learner: Any) -> None:
    async with learner() as me:
        await opens_the_terminal(me)
        await me.types("echo one\n")
        await me.types("echo two\n")
        await me.types("ech")
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
        await opens_the_terminal(me)
        prompt = me.main.query_one(Prompt)
        await me.types("pyt")
        await me.press("tab")
        await me.until(lambda: prompt.value == "python3 ")
        await me.types("sr")
        await me.press("tab")
        await me.until(lambda: prompt.value == "python3 src/")
        await me.press("tab")
        await me.until(lambda: prompt.value == "python3 src/my_package/")


async def test_keys_typed_ahead_keep_their_order(learner: Any) -> None:
    async with learner() as me:
        await opens_the_terminal(me)
        prompt = me.main.query_one(Prompt)
        await me.press(*"bc", "home", "a", "end", "d", "left", "left", "left", "delete", "x", "ctrl+e", "e")
        await me.until(lambda: prompt.value == "axcde", prompt.value)


async def test_cd_and_export_last(learner: Any) -> None:
    async with learner() as me:
        await opens_the_terminal(me)
        await me.types("cd src\n")
        await me.types("export WHERE=here\n")
        await me.types("basename $PWD; echo $WHERE\n")
        await me.until(lambda: output(me).splitlines()[-2:] == ["src", "here"])
        await me.types("cd nowhere\n")
        await me.sees("cd: nowhere: No such file or directory")


async def test_escape_leaves_the_prompt_and_the_keys_of_the_app_work_again(learner: Any) -> None:
    async with learner() as me:
        await opens_the_terminal(me)
        await me.types("echo here\n")
        await me.until(lambda: output(me).splitlines()[-1:] == ["here"])
        await me.press("escape")
        await me.until(lambda: isinstance(me.app.focused, OutputView))
        await me.press("1")
        await me.sees("temperature sensor")


async def test_what_a_program_prints_is_text(learner: Any) -> None:
    async with learner() as me:
        await opens_the_terminal(me)
        await me.types("printf '[b]\\033[31mred\\033[0m \\033]0;title\\007end\\n'\n")
        await me.until(lambda: "[b]red end" in output(me).splitlines())


async def test_a_command_of_the_lesson_is_run_by_key_and_by_click(learner: Any, monkeypatch: Any) -> None:
    body = made.BODY + "\n```bash\necho by \\\n    key   # shown\necho by click\n```\n"
    monkeypatch.setattr(made, "BODY", body)
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


async def test_what_a_program_offers_lies_where_a_killed_apps_files_are_swept(tmp_path: Path) -> None:
    where = tmp_path / "where"
    program = tmp_path / "ros2"
    program.write_text(f'#!/bin/sh\nprintf %s "$_ARGCOMPLETE_STDOUT_FILENAME" > {where}\n')
    program.chmod(0o755)
    env = {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
    await complete("ros2 topic ", 11, env, tmp_path)
    folder = Path(where.read_text()).parent
    assert folder.parent == private_folders.base()
    assert folder.name.startswith("complete.")  # as all that `private_folders` removes
    assert not folder.exists()
