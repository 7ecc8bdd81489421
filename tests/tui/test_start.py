"""The start of the app: what is imported before the first paint, and work that must not be done twice."""

from __future__ import annotations

import gc
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from textual.css.stylesheet import Stylesheet

from tests.tui import fakes
from tutor.cli.global_options import read_alone
from tutor.tui import key_latency
from tutor.tui.app import TutorApp
from tutor.tui.screens.main import MainScreen

BEFORE_THE_FIRST_PAINT = """
import sys
from pathlib import Path
from tutor.cli import app, completion, context
from tutor.cli.global_options import read_alone
from tutor.content import load_course
from tutor.session import Session
from tutor.tui import hangup, key_latency
from tutor.tui.app import TutorApp
from tutor.workspace import Workspace
context.choose_workspace(read_alone(["--workspace", "ws"]))
TutorApp(Session(load_course(None), Workspace(Path("ws"))))
"""


def modules_after(code: str, folder: Path) -> set[str]:
    """Return which modules this program has imported."""
    program = f"{code}\nprint(*sys.modules, sep='\\n')"
    done = subprocess.run([sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_the_first_paint_waits_for_no_module_that_it_does_not_need(tmp_path: Path) -> None:
    late = {
        "rclpy",
        "ctypes",
        "pygments.lexers",
        "markdown_it.main",
        "textual.widgets._markdown",
        "textual.widgets._text_area",
        "tutor.cli.parser",
        "tutor.content.lint",
        "tutor.judge.trace",
        "tutor.mistakes",
        "tutor.process",
        "tutor.ros.stale_segments",
        "tutor.session.node",
        "tutor.session.shell",
        "tutor.tui.screens.main",
    }
    assert modules_after(BEFORE_THE_FIRST_PAINT, tmp_path) & late == set()


def test_the_lesson_waits_for_no_page_that_is_not_open(tmp_path: Path) -> None:
    late = {"rclpy", "tutor.live.protocol", "tutor.mistakes", "tutor.tui.live.pane", "tutor.tui.terminal.pane"}
    assert modules_after("import sys, tutor.tui.screens.main", tmp_path) & late == set()


async def test_the_start_does_no_work_of_the_whole_screen_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Textual would parse all CSS again, restyle all widgets, and lay the screen out again when told its own size."""
    done: list[str] = []

    def count(owner: type, method: str, what: str) -> None:
        then = getattr(owner, method)

        def counted(self: Any, *args: Any, **options: Any) -> None:
            if not isinstance(self, Stylesheet) or app.main is not None:
                done.append(what)
            then(self, *args, **options)

        monkeypatch.setattr(owner, method, counted, raising=False)

    app = TutorApp(fakes.FakeSession(tmp_path / "learner"))
    count(Stylesheet, "reparse", "parsed")
    count(MainScreen, "update_node_styles", "restyled")
    count(MainScreen, "_screen_resized", "laid out")
    async with app.run_test(size=(120, 36)) as pilot:
        await fakes.wait_until_ready(app, pilot)
        assert app.main is not None
        assert done == []
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert done == ["restyled", "laid out"]  # there is another layout for this size
        await app.close_down()


@pytest.fixture
def collection() -> Iterator[None]:
    yield
    gc.unfreeze()
    gc.enable()


@pytest.mark.usefixtures("collection")
def test_garbage_is_collected_again_after_the_start() -> None:
    key_latency.pause_collection()
    assert not gc.isenabled()
    key_latency.resume_collection()
    assert gc.isenabled()
    frozen = gc.get_freeze_count()
    assert frozen
    key_latency.resume_collection()  # nothing is paused: it does nothing
    assert gc.get_freeze_count() == frozen


@pytest.mark.parametrize("argv", [[], ["--workspace", "list"], ["--workspace=ws", "--lessons", "course"]])
def test_the_options_of_the_app_are_read_without_the_parsers_of_all_commands(argv: list[str]) -> None:
    options = read_alone(argv)
    assert options is not None
    assert (options.command, options.plain) == (None, False)


@pytest.mark.parametrize(
    "argv",
    [["list"], ["--workspace"], ["--plain"], ["--help"], ["-h"], ["--work", "ws"], ["--lesons", "x"], ["run", "--"]],
)
def test_anything_else_is_left_to_the_parser_of_all_commands(argv: list[str]) -> None:
    assert read_alone(argv) is None
