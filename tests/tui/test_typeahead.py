"""Typing faster than the app can keep up with: every key takes effect, in the order typed."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

from textual.events import Key, Paste
from textual.keys import _character_to_key

from tests.benchmarks.terminal import Terminal
from tests.tui import fakes
from tutor.content import load_course
from tutor.tui.widgets.code_body import CodeBody
from tutor.workspace import Workspace, start

APP = "import sys; from tutor.cli import main; sys.exit(main())"

END, HOME, LEFT, DELETE = b"\x1b[F", b"\x1b[H", b"\x1b[D", b"\x1b[3~"


def type_ahead(me: Any, *typed: str | Paste) -> None:
    """Send all of these keys before the app has handled any of them."""
    for each in typed:
        if isinstance(each, str):
            key = _character_to_key(each) if len(each) == 1 else each
            me.app.post_message(Key(key, each if len(each) == 1 else None))
        else:
            me.app.post_message(each)


async def test_keys_typed_after_a_command_go_where_it_leads_into_a_dialog_too(learner: Any) -> None:
    async with learner() as me:
        await me.press("2")
        await me.until(lambda: me.main.query_one(CodeBody).has_focus)
        await me.sees("1  import signal")
        editor, (first, rest) = me.editor, fakes.NODE.split("\n", 1)
        expected = f"rcq{first}x\n{rest}"
        type_ahead(me, "e", *"rcq", "escape", *"1", "n", "p", "3", "2", "e", "end", *"x")
        await me.until(lambda: editor.text == expected)
        assert me.main.page == "code"
        assert me.app.focused is editor

        type_ahead(me, "escape", "o", *"rate:=2.0", "enter", *"b:=1", "f5", "2", "e", "home", *"z")
        await me.until(lambda: me.main.model.run_options.parameters == ("rate:=2.0", "b:=1"), "typed in the dialog")
        await me.until(lambda: me.editor.text == f"z{expected}", "typed in the editor after the dialog")


async def test_moves_and_letters_keep_their_order_and_keys_still_work_after_the_focused_widget_is_gone(
    learner: Any,
) -> None:
    async with learner() as me:
        editor = await me.focus_editor()
        type_ahead(me, *"ab", "home", *"c", "end", *"d", "left", "left", *"e", "enter", *"f", "backspace", *"g", "home")
        type_ahead(me, Paste("pasted"), "end", *"!")
        await me.until(lambda: "!" in editor.text)
        first, second = (fakes.NODE.split("\n")[0] + "d"), "pastedg"
        typed = "cab" + first
        assert editor.text.split("\n")[:2] == [typed[:-2] + "e", second + typed[-2:] + "!"]

        me.file.unlink()
        type_ahead(me, "down", "end")
        await editor.remove()
        type_ahead(me, "f1")
        await me.sees("Read the lesson, start")


def test_a_burst_of_bytes_in_a_real_terminal_becomes_the_intended_text(tmp_path: Path) -> None:
    lesson = load_course().lessons[0]
    workspace = Workspace(tmp_path / "ws")
    start(lesson, workspace)
    file = workspace.path_of(lesson.files[0].name)
    file.write_text("\nlast\n")
    app = Terminal([sys.executable, "-c", APP, "--workspace", str(workspace.root)], dict(os.environ))
    try:
        app.wait_for_text(b"Objective")
        app.press(b"2")
        app.wait_for_text(b"last")
        line = b"x = 1" + HOME + b"#!/usr/" + END + LEFT + DELETE + b"bin" + HOME + b"y" + END + b"\r"
        app.press(b"e" + line * 8 + b"end\x13")  # Ctrl+S
        app.wait_for_text(b"is saved.")
    finally:
        app.close()
    assert file.read_text() == "y#!/usr/x = bin\n" * 8 + "end\nlast\n"
