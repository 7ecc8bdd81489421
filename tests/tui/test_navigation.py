"""Opening the app, navigation, and the layout of the screen."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import pytest
from textual.color import Color
from textual.css.stylesheet import Stylesheet
from textual.events import AppBlur, Paste
from textual.widgets._footer import FooterKey
from textual.widgets.markdown import MarkdownBlock

from tests.tui import fakes
from tutor.tui.app import TutorApp
from tutor.tui.commands import all_commands
from tutor.tui.control.pages import Criteria, Layout, layout_for
from tutor.tui.dialogs.help import KeyTable
from tutor.tui.themes import BACKGROUNDS, DARK, LIGHT, TEXT_COLOURS
from tutor.tui.widgets.criteria import CriteriaPanel

SIZES = [(120, 36), (80, 24)]


@pytest.mark.parametrize("size", SIZES)
async def test_the_welcome_screen_says_where_the_work_will_be_and_enter_leads_to_the_lessons(
    learner: Any, size: Any
) -> None:
    async with learner(size, started=False) as me:
        await me.sees("Learn ROS 2", "Your work will be in", "Press Enter")
        assert not me.session.workspace.exists
        await me.press("enter")
        await me.sees("I1.1  Sensor Publisher", "Objective")
        assert me.session.workspace.exists
        assert me.session.path(me.session.lessons[0].files[0]).exists()

        # The next and the previous lesson.
        await me.press("n")
        await me.sees("I1.3  Calculator Service", "temperature sensor (i1.3)")
        await me.press("n", "n")
        await me.sees("I2.3  Multi-Threaded Service", "This is the last lesson.")
        await me.press("p", "p")
        await me.sees("I1.1  Sensor Publisher")


async def test_the_workspace_can_be_elsewhere_and_is_found_the_next_time(learner: Any, tmp_path: Path) -> None:
    async with learner((80, 24), started=False) as me:
        default, other = me.session.workspace.root, tmp_path / "elsewhere"
        (tmp_path / "file").touch()
        await me.sees("Your work will be in")
        await me.press("f", "ctrl+u")
        await me.sees("Name a folder")
        me.app.post_message(Paste(str(tmp_path / "file")))
        await me.sees("is a file, not a folder")
        await me.press("enter")
        assert not me.session.workspace.exists
        await me.press("ctrl+u")
        me.app.post_message(Paste(str(other)))
        await me.sees("will lead to it")
        await me.press("enter")
        await me.sees("I1.1  Sensor Publisher", "Objective")
        assert me.file.is_relative_to(other)
        assert default.resolve() == other


async def test_quitting_the_welcome_screen_creates_no_workspace(learner: Any) -> None:
    async with learner(started=False) as me:
        await me.sees("Your work will be in")
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        assert not me.session.workspace.exists


async def test_the_lessons_are_listed_with_difficulty_and_progress_and_opened_by_click_and_key(learner: Any) -> None:
    async with learner() as me:
        await me.sees(
            "I1.1 Sensor Publisher", "●○○ easy", "started", "●●○ medium", "●●● challenge", "new", "0 of 3 passed"
        )
        await me.pilot.click(me.main.query_one("#lessons").query("LessonRow")[1])
        await me.sees("I1.3  Calculator Service")

        # Home and End work in the lists, and keys from the help work everywhere.
        await me.press("l", "l", "end", "enter")
        await me.sees("I2.3  Multi-Threaded Service")
        await me.press("l", "l", "home", "enter")
        await me.sees("I1.1  Sensor Publisher")
        await me.press("i")
        await me.sees("There is no evidence here")
        await me.press("5", "end", "enter")
        await me.sees("shutdown  Ctrl+C ends the node cleanly")


async def test_the_panels_fold_in_a_small_terminal_and_unfold_when_it_grows(learner: Any) -> None:
    async with learner((80, 24)) as me:
        await me.sees("Lesson", "Code", "Log", "Criteria", "q Quit")
        await me.until(lambda: "0/3" in me.screen().partition("\n")[0], "the progress in the header")

        # The lessons are a drawer, and the criteria a tab.
        assert "0 of 3 passed" not in me.screen()
        await me.press("l")
        await me.sees("0 of 3 passed")
        await me.press("down", "enter")
        await me.sees("I1.3  Calculator Service")
        assert "0 of 3 passed" not in me.screen()
        await me.press("5")
        await me.sees("The publishing rate can be set with a parameter")

        await me.pilot.resize_terminal(120, 36)
        await me.sees("0 of 3 passed", "Objective", "not checked yet")
        await me.until(lambda: "0 of 3 passed" in me.screen().partition("\n")[0], "the progress in the header")
        await me.pilot.resize_terminal(180, 50)
        await me.sees("0 of 3 passed", "Objective", "not checked yet")
        await me.pilot.resize_terminal(60, 18)
        await me.sees_no("0 of 3 passed")
        await me.sees("Objective")


@pytest.mark.parametrize("size", [(120, 36), (200, 60)])
async def test_z_enlarges_the_part_with_the_focus_and_restores_it(learner: Any, size: Any) -> None:
    def sizes() -> tuple[tuple[int, int], tuple[int, int]]:
        page, criteria = me.main.query_one("#pages").region.size, me.main.query_one("#criteria").region.size
        return (page.width, page.height), (criteria.width, criteria.height)

    async with learner(size) as me:
        await me.press("5")
        await me.sees("not checked yet")
        before = sizes()
        await me.press("z")
        await me.until(lambda: sizes() == ((0, 0), (size[0], size[1] - 2)), "only the criteria")
        await me.press("down", "z")
        await me.until(lambda: sizes() == before, "restored")
        assert me.main.chosen_criterion == "publishes"
        await me.press("z", "2")
        await me.sees("the sensor is warm")
        await me.until(lambda: sizes()[0] == before[0], "another page restores it, too")
        await me.press("escape", "z")
        await me.until(lambda: sizes() == ((size[0], size[1] - 4), (0, 0)), "only the page")
        await me.press("5")
        await me.until(lambda: sizes()[1] == before[1], "the criteria restore the panels")
        await me.press("z", "l")
        await me.until(lambda: sizes() == before, "and so does the list of lessons")


def test_the_layout_follows_the_size() -> None:
    assert layout_for(60, 24) == Layout(False, Criteria.FOLDED)
    assert layout_for(80, 24) == Layout(False, Criteria.FOLDED, columns=True)
    assert layout_for(80, 50) == Layout(False, Criteria.FOLDED)
    assert layout_for(120, 24) == Layout(True, Criteria.FOLDED, columns=True)
    assert layout_for(120, 36) == Layout(True, Criteria.STACKED)
    assert layout_for(200, 50) == Layout(True, Criteria.BESIDE)


async def test_moving_the_focus_restyles_frames_but_neither_text_nor_footer_keys(
    learner: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    styled: list[object] = []
    apply = Stylesheet.apply

    def record_and_apply(sheet: Stylesheet, node: Any, **options: Any) -> None:
        styled.append(node)
        apply(sheet, node, **options)

    async with learner() as me:
        await me.sees("Objective")
        pages, criteria = me.main.query_one("#pages"), me.main.query_one(CriteriaPanel)
        texts, keys = [*me.main.query(MarkdownBlock)], [*me.main.query(FooterKey)]
        frame = pages.styles.border_bottom
        assert texts
        assert keys
        monkeypatch.setattr(Stylesheet, "apply", record_and_apply)
        while not criteria.has_focus_within:
            await me.press("tab")
        await me.until(lambda: criteria.styles.border_bottom == frame)
        assert pages.styles.border_bottom != frame
        assert styled
        assert not {*texts} & {*styled}
        assert [*me.main.query(FooterKey)] == keys


async def test_every_command_has_a_handler_and_help_names_every_key(learner: Any) -> None:
    async with learner() as me:
        assert {me.main.can(command) for command in all_commands()} == {True, False}
        await me.press("question_mark")
        await me.sees("Run your node in your own ROS domain", "Ctrl+P")
        tables = me.app.screen.query(KeyTable)
        help = "\n".join(str(table.render()) for table in tables)
        assert "Stop everything and leave" in help
        assert not [key for key in ("Ctrl+F", "Ctrl+G", "Ctrl+A", "Ctrl+Home", "Ctrl+End", "Ctrl+Z") if key not in help]
        assert all(len(line) <= table.size.width for table in tables for line in str(table.render()).split("\n"))
        left, right = tables
        assert left.region.right < right.region.x, "a text and the key beside it would read as one word"
        await me.press("escape")
        await me.sees_no("Run your node in your own ROS domain")

        assert me.app.current_theme.dark
        await me.press("t")
        assert not me.app.current_theme.dark


async def test_the_palette_goes_to_a_lesson_and_to_a_line_in_one(learner: Any) -> None:
    async with learner((80, 24)) as me:
        await me.press("ctrl+p", *"calc")
        await me.sees("Go to I1.3 Calculator Service")
        await me.press("down", "enter")
        await me.sees("I1.3  Calculator Service")

        await me.press("ctrl+p")
        me.paste("random")
        await me.sees("Publish random values from 20.0 to 30.0", "I2.3 Multi-Threaded Service, line")
        await me.press("up", "enter")
        await me.until(lambda: me.main.model.lesson.id == "i2.3", "the lesson is open")
        await me.sees("I2.3  Multi-Threaded Service", "Publish random values")


async def test_a_page_in_a_browser_shows_the_keys_before_the_first_one(
    learner: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(TutorApp, "is_web", True)
    opened = TutorApp.get_default_screen

    def opened_without_focus(self: TutorApp) -> Any:
        self.post_message(AppBlur())  # as Textual's driver does
        return opened(self)

    monkeypatch.setattr(TutorApp, "get_default_screen", opened_without_focus)
    async with learner() as me:
        await me.sees("c Check", "q Quit")
        assert me.app.focused is not None
        me.app.post_message(AppBlur())
        await me.until(lambda: not me.app.app_focus, "the page has lost the focus")
        await me.sees("c Check", "q Quit")


@pytest.mark.parametrize("theme", [DARK, LIGHT], ids=lambda theme: theme.name)
def test_every_text_colour_has_enough_contrast_on_every_background(theme: Any) -> None:
    def luminance(color: Color) -> float:
        parts = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color.normalized]
        return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]

    texts = {name: theme.variables[name] for name in TEXT_COLOURS} | {
        name: getattr(theme, name) for name in ("foreground", "primary", "secondary", "accent")
    }
    for background in BACKGROUNDS:
        below = luminance(Color.parse(getattr(theme, background)))
        for name, colour in texts.items():
            above = luminance(Color.parse(colour))
            ratio = (max(above, below) + 0.05) / (min(above, below) + 0.05)
            assert ratio >= 4.5, f"{name} on {background}: {ratio:.2f}"


async def test_the_code_follows_the_file_on_disk_and_f_shows_the_other_file(learner: Any) -> None:
    async with learner() as me:
        await me.press("2")
        await me.sees("1  import signal", "thermometer.py")
        path: Path = me.session.path(me.session.lessons[0].files[0])
        path.write_text("x = 1\n" + "y = '" + "long " * 60 + "'\n\ttabbed = 'a\x1b[31mb'\n")
        await me.sees("1  x = 1", "2  y = 'long", "3      tabbed = 'a")
        removed = me.editor
        path.unlink()
        await me.sees("thermometer.py is not in your workspace yet")
        await me.until(lambda: not removed.is_attached)
        assert not removed.render_line(0).text.strip(), "painted until the next layout, though its styles are gone"

        await me.press("n", "s")
        await me.sees("server.py and client.py", "1  import signal")
        await me.press("escape", "f")
        await me.until(lambda: me.main.model.file_index == 1)
        await me.pilot.click("#code-head", offset=(2, 0))
        assert (await asyncio.to_thread(me.session.path(me.session.lessons[1].files[1]).read_text)) == fakes.NODE
