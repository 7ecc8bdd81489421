"""Editing in the app, and conflicts with changes made outside it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from textual.widgets import Input

from tests.tui import fakes
from tutor.tui.widgets.code_pane import CodePane
from tutor.workspace import back_up_file


def backups(path: Path) -> list[str]:
    return sorted(other.read_text() for other in path.parent.glob(f"{path.name}.~*~"))


async def test_typing_is_autosaved_and_a_change_from_outside_is_loaded(learner: Any) -> None:
    async with learner() as me:
        editor = await me.focus_editor()
        await me.sees("Esc Commands", "Ctrl+S Save", "F5 Run", "F9 Check")
        await me.press(*"rcq", "enter")
        await me.until(lambda: me.file.read_text() == "rcq\n" + fakes.NODE, "saved without asking")
        await me.sees("✓ saved")
        await me.press(*["ctrl+z"] * 4)  # at most one undo per key; quick typing is undone in one step
        await me.until(lambda: me.file.read_text() == fakes.NODE, "undone, and saved")
        await me.press("escape", "1")
        await me.sees("Objective")
        assert editor.text == fakes.NODE

        # A change made outside is loaded, leaves the cursor where it was, and can be undone.
        await me.focus_editor()
        await me.press("ctrl+home", "down", "down", "right")
        me.file.write_text("# theirs\n" + fakes.NODE)
        await me.sees("was changed outside", "# theirs")
        assert editor.cursor_location == (3, 1), "the same line, now one row further down"
        await me.press("ctrl+z")
        await me.until(lambda: me.file.read_text() == fakes.NODE)


async def test_letters_typed_before_editing_offer_to_edit_and_run_no_command(learner: Any) -> None:
    async with learner() as me:
        await me.press("2")
        await me.sees("the sensor is warm", "e Edit", "Esc Commands", "F5 Run", "F9 Check", "Esc, then  k")
        assert "c Check" not in me.screen()
        await me.type_text("import random")
        await me.sees("Edit your file?", "import random", "Enter: type this there")
        assert me.file.read_text() == fakes.NODE
        assert len(me.app.screen_stack) == 2, "no dialog"
        assert not me.main.nodes.running
        await me.press("enter", "enter")
        await me.until(lambda: me.file.read_text() == "import random\n" + fakes.NODE, "what was typed is kept")
        await me.press("x")
        await me.until(lambda: me.editor.text.startswith("import random\nximport signal"), "and typing goes on")

        # Esc leaves the editor for commands, as ever.
        await me.press("ctrl+z", "escape")
        await me.sees("c Check", "k Skeleton")
        await me.press("k")
        await me.sees("The skeleton, read-only")
        await me.press("escape", "k")
        await me.sees("The skeleton, read-only")

        # Esc takes the offer back: letters are commands then, until the page is opened again.
        await me.press("escape", "1", "2", "k")
        await me.sees("Edit your file?", "k again: Skeleton", "Esc: neither")
        await me.press("escape")
        await me.sees_no("Edit your file?")
        await me.press("k")
        await me.sees("The skeleton, read-only")
        await me.press("escape")

        # The same letter once more is its command; a second one is text.
        await me.press("1", "2", "k", "k")
        await me.sees("The skeleton, read-only")
        await me.press("escape", "1", "2", "l", "m")
        await me.sees("Edit your file?")
        assert me.main.query_one("#offer-text", Input).value == "lm"
        await me.press("escape")

        # A paste is offered, too. The other keys work at once: pages, help, F keys, and e.
        await me.press("1", "2")
        me.paste("# pasted\n# twice\n")
        await me.sees("Edit your file?")
        await me.press("enter")
        await me.until(lambda: "# pasted\n# twice" in me.file.read_text(), "pasted")
        await me.press("escape", "1", "2", "question_mark")
        await me.sees("Read the lesson, start, edit")
        await me.press("escape", "e")
        await me.until(lambda: me.app.focused is me.editor)


async def test_ctrl_f_finds_a_text_and_typing_replaces_what_is_selected_and_is_indented(learner: Any) -> None:
    async with learner() as me:
        editor = await me.focus_editor()
        rows = [row for row, line in enumerate(fakes.NODE.split("\n")) for _ in range(line.count('log("'))]
        await me.press("ctrl+f", *'LOG("')
        await me.sees("not found")
        await me.press("ctrl+u", *'log("')
        await me.sees(f"1 of {len(rows)}")
        assert editor.selected_text == 'log("'
        seen = []
        for key in ("enter", "down", "enter", "enter", "up"):
            await me.press(key)
            await me.pilot.pause()
            seen.append(editor.selection.start[0])
        assert seen == [rows[1], rows[2], rows[3], rows[0], rows[3]], "wraps around at the end, and back"
        await me.press("escape", "ctrl+g")
        await me.until(
            lambda: editor.selected_text == 'log("' and editor.selection.start[0] == rows[0], "the next match"
        )
        await me.press("X")
        assert (text := editor.text) == fakes.NODE.replace('log("', "X", 1), "typing replaces the match"

        # To both ends of the file, and all of it selected and replaced, by lines that are indented as Python is.
        await me.press("ctrl+end")
        assert editor.cursor_location == editor.document.end
        await me.press("ctrl+home")
        assert editor.cursor_location == (0, 0)
        await me.press("ctrl+shift+end")
        assert editor.selected_text == text
        await me.press("ctrl+a")
        await me.type_text("def f():\nif x:\nreturn 1\nreturn\ny")
        expected = "def f():\n    if x:\n        return 1\n    return\ny"
        await me.until(lambda: me.file.read_text() == expected, expected)
        await me.type_text("\nif y:\n")
        await me.until(lambda: editor.text == expected + "\nif y:\n    ", "indented")
        await me.press("backspace")
        await me.until(lambda: editor.text == expected + "\nif y:\n", "dedented")
        await me.press("escape", "ctrl+f", "escape", "1")
        await me.sees("Objective")


async def cause_conflict(me: Any) -> None:
    """Type, and change the file outside before autosave writes it: at once, as that takes only half a second."""
    me.editor.insert("m")
    me.file.write_text("theirs = 1\n")
    await me.sees("was changed outside", "Keep mine", "Take the file's")


async def start_again(me: Any) -> None:
    """Remove the backups, and have the editor show the skeleton, with the cursor at its very beginning."""
    for backup in me.file.parent.glob(f"{me.file.name}.~*~"):
        backup.unlink()
    me.file.write_text(fakes.NODE)
    await me.until(lambda: me.editor.text == fakes.NODE, "loaded")
    await me.press("ctrl+home")


async def test_in_a_conflict_either_version_is_kept_and_the_other_is_backed_up(
    learner: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with learner((80, 24)) as me:
        # The learner keeps their version.
        await me.focus_editor()
        await cause_conflict(me)
        assert backups(me.file) == ["m" + fakes.NODE]
        await me.press("d")
        await me.sees("- theirs = 1", "+ mimport signal")
        await me.press("enter")
        await me.sees("Your version is saved")
        assert me.file.read_text() == "m" + fakes.NODE
        assert backups(me.file) == ["theirs = 1\n"]

        # They take the file's version.
        await start_again(me)
        await cause_conflict(me)
        await me.press("escape")
        await me.sees("version is shown", "theirs = 1")
        assert me.file.read_text() == "theirs = 1\n"
        assert backups(me.file) == ["m" + fakes.NODE]
        assert me.editor.cursor_location == (0, 1), "unchanged"
        await me.press("x")
        await me.until(lambda: me.file.read_text() == "txheirs = 1\n", "typing continues")

        # They take it, having typed on while their version was backed up: that is backed up, too.
        def back_up_while_typing(path: Path, text: str) -> Path:
            if text == "m" + fakes.NODE:
                me.app.call_from_thread(me.editor.insert, "ore")
            return back_up_file(path, text)

        await start_again(me)
        monkeypatch.setattr("tutor.tui.control.files.back_up_file", back_up_while_typing)
        await cause_conflict(me)
        await me.press("escape")
        await me.until(lambda: me.editor.text == "theirs = 1\n")
        assert backups(me.file) == ["m" + fakes.NODE, "more" + fakes.NODE]


async def test_the_views_of_the_code_and_a_reset_that_keeps_a_backup(learner: Any) -> None:
    async with learner() as me:
        me.file.write_text(fakes.NODE.replace("the sensor is warm", "hot"))
        await me.press("d")
        await me.sees("Your changes to the skeleton: 1 lines added (+), 1 removed (-)")
        await me.sees('- log("WARN", "the sensor is warm")', '+ log("WARN", "hot")')
        await me.press("d")
        await me.until(lambda: "+ log" not in me.screen())
        await me.press("k")
        await me.sees("The skeleton, read-only", "the sensor is warm")
        await me.press("escape", "V", "enter")
        await me.sees("From yours to our solution", "+ # the solution")
        await me.press("escape", "Z")
        await me.sees("becomes the skeleton again")
        await me.press("enter")
        await me.sees("is the skeleton again. Yours is kept as", "the sensor is warm")
        assert me.file.read_text() == fakes.NODE
        assert len(backups(me.file)) == 1


async def test_a_file_that_is_still_being_read_when_the_app_closes_is_not_shown(learner: Any) -> None:
    async with learner((80, 24)) as me:
        pane = me.main.query_one(CodePane)
        await me.app.close_down()
        await pane.remove_children()
        await me.main.files.refresh(me.file)
        assert not pane.children


async def test_what_is_no_text_is_left_alone_function_keys_work_and_quitting_saves_pending_edits(learner: Any) -> None:
    async with learner((80, 24)) as me:
        me.file.write_bytes(b"\xff\xfe")
        await me.press("2")
        await me.sees("cannot be shown", "is not UTF-8")
        assert me.file.read_bytes() == b"\xff\xfe"
        me.file.write_text(fakes.NODE)
        await me.sees("1  import signal")

        # Function keys run the commands that help lists, and do not select text.
        editor = await me.focus_editor()
        await me.press("f6")
        assert not editor.selected_text
        await me.press("f7")
        await me.until(lambda: me.main.page == "live")
        assert not editor.selected_text

        await me.focus_editor()
        await me.press("x", "ctrl+q")
        await me.until(lambda: me.app.return_code == 0)
        assert me.file.read_text() == "x" + fakes.NODE
