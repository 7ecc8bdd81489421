"""E hands the terminal over to the learner's own editor, and takes it back however that ends."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.benchmarks.terminal import Terminal
from tutor.content import load_course
from tutor.errors import EditorError
from tutor.process.process_table import processes
from tutor.tui.outside_editor import editor_command
from tutor.workspace import Workspace, start

APP = "import sys; from tutor.cli import main; sys.exit(main())"


class TerminalLearner:
    """A learner in a real terminal, whose PATH holds only the editors that the test installs."""

    def __init__(self, folder: Path) -> None:
        self.programs = folder / "bin"
        self.programs.mkdir()
        lesson = load_course().lessons[0]
        self.workspace = Workspace(folder / "ws")
        start(lesson, self.workspace)
        self.file = self.workspace.path_of(lesson.files[0].name)
        self.app: Terminal | None = None

    def install(self, name: str, script: str) -> Path:
        program = self.programs / name
        program.write_text(script)
        program.chmod(0o755)
        return program

    def open_app(self, **environ: str) -> Terminal:
        kept = {name: value for name, value in os.environ.items() if name not in ("EDITOR", "VISUAL")}
        argv = [sys.executable, "-c", APP, "--workspace", str(self.workspace.root)]
        self.app = Terminal(argv, {**kept, "PATH": str(self.programs), **environ})
        self.app.wait_for_text(b"Objective")
        return self.app

    def assert_responsive(self) -> None:
        """Assert that the app is still running and reacts to keys."""
        assert self.app is not None
        self.app.press(b"?")
        self.app.wait_for_text(b"Read the lesson, start")


@pytest.fixture
def me(tmp_path: Path) -> Iterator[TerminalLearner]:
    learner = TerminalLearner(tmp_path)
    try:
        yield learner
    finally:
        if learner.app is not None:
            learner.app.close()


EDITOR_SCRIPT = (
    '#!/bin/sh\necho "opened by ${0##*/}"\nfor last; do :; done\necho "# edited with $# words: $1" > "$last"\n'
)


def test_without_a_configured_editor_an_installed_one_opens(me: TerminalLearner) -> None:
    me.install("vi", EDITOR_SCRIPT)
    app = me.open_app(EDITOR=" ")
    app.press(b"E")
    app.wait_for_text(b"opened by vi")
    app.wait_for_text(b"# edited with 1 words")
    me.assert_responsive()


def test_a_failing_editor_is_reported_in_the_app_which_continues_and_opens_it_with_arguments_later(
    me: TerminalLearner,
) -> None:
    app = me.open_app(EDITOR="code -w")
    for script, message in (
        ("", b"There is no program code"),
        ("#!/no/such/shell\n", b"cannot be started"),
        ("#!/bin/sh\nexit 3\n", b"code ended with exit code 3"),
        (EDITOR_SCRIPT, b"# edited with 2 words: -w"),
    ):
        if script:
            me.install("code", script)
        app.press(b"E")
        app.wait_for_text(message)
    me.assert_responsive()


def which_of(*names: str) -> Callable[[str], str | None]:
    return lambda name: f"/usr/bin/{name}" if name in names else None


def test_the_order_in_which_editors_are_chosen() -> None:
    assert editor_command({"VISUAL": "code -w", "EDITOR": "nano"}, which_of("code", "nano")) == ["code", "-w"]
    assert editor_command({"VISUAL": "", "EDITOR": "nano"}, which_of("nano", "vi")) == ["nano"]
    assert editor_command({}, which_of("sensible-editor", "nano")) == ["sensible-editor"]
    for unset in ({}, {"EDITOR": ""}, {"EDITOR": " "}):
        assert editor_command(unset, which_of("vim", "vi")) == ["vim"]
    with pytest.raises(EditorError, match="No editor is installed"):
        editor_command({}, which_of())


def test_an_editor_that_is_not_a_command_is_reported() -> None:
    with pytest.raises(EditorError, match="EDITOR is not a command"):
        editor_command({"EDITOR": "'unclosed"}, which_of("vi"))


def test_processes_that_an_editor_leaves_behind_are_not_adopted_by_the_app(me: TerminalLearner) -> None:
    """As VS Code does: the command exits, and its window stays behind as a daemon."""
    left = me.file.with_name("left")
    me.install("ed", f"#!/bin/sh\n(sleep 60 & echo $! >{left}.new; mv {left}.new {left}) </dev/null\n")
    app = me.open_app(EDITOR="ed", PATH=f"{me.programs}{os.pathsep}{os.environ['PATH']}")
    for _ in range(2):  # the second time, too: after each editor, the app adopts orphans again
        app.press(b"E")
        deadline = time.monotonic() + 30
        while not left.exists():
            assert time.monotonic() < deadline
            app.read(0.02)
        app.wait_for_text(b"not checked yet", resumed=True)
        daemon = int(left.read_text())
        left.unlink()
        try:
            assert processes()[daemon].parent != app.pid
        finally:
            os.kill(daemon, signal.SIGKILL)
