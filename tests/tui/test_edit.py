"""Editing in the app, and what happens when the file is changed outside at the same time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.tui import made
from tutor.tui.widgets.code_pane import CodePane
from tutor.workspace import back_up_file


def backups(path: Path) -> list[str]:
    return sorted(other.read_text() for other in path.parent.glob(f"{path.name}.~*~"))


async def test_letters_type_and_are_saved_by_themselves_and_the_keys_of_commands_work_after_esc(learner: Any) -> None:
    async with learner() as me:
        editor = await me.edits()
        await me.sees("Esc Commands", "Ctrl+S Save", "F5 Run", "F9 Check")
        await me.press(*"rcq", "enter")
        await me.until(lambda: me.file.read_text() == "rcq\n" + made.NODE, "saved without asking")
        await me.sees("✓ saved")
        await me.press(*["ctrl+z"] * 4)  # at most one for each key; what is typed quickly is undone at once
        await me.until(lambda: me.file.read_text() == made.NODE, "undone, and saved")
        await me.press("escape", "1")
        await me.sees("Objective")
        assert editor.text == made.NODE


async def test_the_editor_indents_as_python_wants_it(learner: Any) -> None:
    async with learner() as me:
        me.file.write_text("")
        editor = await me.edits()
        await me.until(lambda: editor.text == "")
        await me.types("def f(x):\nif x:\nreturn 1\nreturn 2\ny = 3")
        wanted = "def f(x):\n    if x:\n        return 1\n    return 2\ny = 3"
        await me.until(lambda: editor.text == wanted, wanted)
        await me.types("\nif y:\n")
        await me.until(lambda: editor.text == wanted + "\nif y:\n    ", "set in")
        await me.press("backspace")
        await me.until(lambda: editor.text == wanted + "\nif y:\n", "one step back")


async def test_a_change_outside_is_taken_over_with_the_cursor_where_it_was_and_can_be_undone(learner: Any) -> None:
    async with learner() as me:
        editor = await me.edits()
        await me.press("down", "down", "right")
        me.file.write_text("# theirs\n" + made.NODE)
        await me.sees("was changed outside", "# theirs")
        assert editor.cursor_location == (3, 1), "the same line, a row further down"
        await me.press("ctrl+z")
        await me.until(lambda: me.file.read_text() == made.NODE)


async def conflict(me: Any) -> None:
    """Type, and have somebody else write the file before it is saved: at once, as that is a matter of half a second."""
    (await me.edits()).insert("m")
    me.file.write_text("theirs = 1\n")
    await me.sees("was changed outside", "Keep mine", "Take the file's")


async def test_changed_on_both_sides_the_learner_keeps_theirs_and_the_other_one_is_a_backup(learner: Any) -> None:
    async with learner() as me:
        await conflict(me)
        assert backups(me.file) == ["m" + made.NODE]
        await me.press("d")
        await me.sees("- theirs = 1", "+ mimport signal")
        await me.press("enter")
        await me.sees("Your version is saved")
        assert me.file.read_text() == "m" + made.NODE
        assert backups(me.file) == ["theirs = 1\n"]


async def test_changed_on_both_sides_the_learner_takes_the_files_and_theirs_is_a_backup(learner: Any) -> None:
    async with learner((80, 24)) as me:
        await conflict(me)
        await me.press("escape")
        await me.sees("version is shown", "theirs = 1")
        assert me.file.read_text() == "theirs = 1\n"
        assert backups(me.file) == ["m" + made.NODE]
        assert me.editor.cursor_location == (0, 1), "where it was"
        await me.press("x")
        await me.until(lambda: me.file.read_text() == "txheirs = 1\n", "and typing goes on")


async def test_what_is_typed_while_the_backup_is_written_is_in_a_backup_too(
    learner: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with learner() as me:

        def meanwhile(path: Path, text: str) -> Path:
            if text == "m" + made.NODE:
                me.app.call_from_thread(me.editor.insert, "ore")
            return back_up_file(path, text)

        monkeypatch.setattr("tutor.tui.control.files.back_up_file", meanwhile)
        await conflict(me)
        await me.press("escape")
        await me.until(lambda: me.editor.text == "theirs = 1\n")
        assert backups(me.file) == ["m" + made.NODE, "more" + made.NODE]


async def test_the_looks_at_the_code_and_a_reset_that_keeps_a_backup(learner: Any) -> None:
    async with learner() as me:
        me.file.write_text(made.NODE.replace("the sensor is warm", "hot"))
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
        assert me.file.read_text() == made.NODE
        assert len(backups(me.file)) == 1


async def test_what_is_typed_is_saved_before_leaving(learner: Any) -> None:
    async with learner() as me:
        await me.edits()
        await me.press("x", "ctrl+q")
        await me.until(lambda: me.app.return_code == 0)
        assert me.file.read_text() == "x" + made.NODE


async def test_a_file_that_is_still_being_read_when_the_app_closes_is_shown_nowhere(learner: Any) -> None:
    async with learner() as me:
        pane = me.main.query_one(CodePane)
        await me.main.close_down()
        await pane.remove_children()
        await me.main.files.look(me.file)
        assert not pane.children


async def test_a_file_that_is_not_a_text_is_left_alone(learner: Any) -> None:
    async with learner() as me:
        me.file.write_bytes(b"\xff\xfe")
        await me.press("2")
        await me.sees("cannot be shown", "is not UTF-8")
        assert me.file.read_bytes() == b"\xff\xfe"


async def test_i_find_a_text_with_ctrl_f_and_go_from_place_to_place(learner: Any) -> None:
    async with learner() as me:
        editor = await me.edits()
        rows = [row for row, line in enumerate(made.NODE.split("\n")) for _ in range(line.count('log("'))]
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
        assert seen == [rows[1], rows[2], rows[3], rows[0], rows[3]], "round the end, and back"
        await me.press("escape", "ctrl+g")
        await me.until(lambda: editor.selected_text == 'log("' and editor.selection.start[0] == rows[0], "and again")
        await me.press("X")
        assert editor.text == made.NODE.replace('log("', "X", 1), "what was found is what is typed over"
        await me.press("escape", "ctrl+f", "escape", "1")
        await me.sees("Objective")


async def test_i_select_all_and_go_to_both_ends_of_the_file(learner: Any) -> None:
    async with learner() as me:
        editor = await me.edits()
        await me.press("ctrl+end")
        assert editor.cursor_location == editor.document.end
        await me.press("ctrl+home")
        assert editor.cursor_location == (0, 0)
        await me.press("ctrl+shift+end")
        assert editor.selected_text == made.NODE
        await me.press("ctrl+a", *"x = 1")
        await me.until(lambda: me.file.read_text() == "x = 1", "all of it replaced")


async def test_in_the_editor_the_function_keys_are_those_of_the_help(learner: Any) -> None:
    async with learner() as me:
        editor = await me.edits()
        await me.press("f6")
        assert not editor.selected_text
        await me.press("f7")
        await me.until(lambda: me.main.page == "live")
        assert not editor.selected_text
