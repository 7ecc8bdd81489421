"""E hands the terminal to the learner's own editor, and gets it back whatever becomes of that."""

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
from tutor.process.supervisor import processes
from tutor.tui.outside_editor import editor_command
from tutor.workspace import Workspace, start

APP = "import sys; from tutor.cli import main; sys.exit(main())"


class Seated:
    """A learner in a real terminal, with editors of their own on PATH."""

    def __init__(self, folder: Path) -> None:
        self.programs = folder / "bin"
        self.programs.mkdir()
        lesson = load_course().lessons[0]
        self.workspace = Workspace(folder / "ws")
        start(lesson, self.workspace)
        self.file = self.workspace.path_of(lesson.files[0].name)
        self.app: Terminal | None = None

    def installs(self, name: str, script: str) -> Path:
        program = self.programs / name
        program.write_text(script)
        program.chmod(0o755)
        return program

    def opens(self, **environ: str) -> Terminal:
        kept = {name: value for name, value in os.environ.items() if name not in ("EDITOR", "VISUAL")}
        argv = [sys.executable, "-c", APP, "--workspace", str(self.workspace.root)]
        self.app = Terminal(argv, {**kept, "PATH": str(self.programs), **environ})
        self.app.until(b"Objective")
        return self.app

    def works_on(self) -> None:
        """The app is there, and takes keys."""
        assert self.app is not None
        self.app.press(b"?")
        self.app.until(b"Read the lesson, start")


@pytest.fixture
def me(tmp_path: Path) -> Iterator[Seated]:
    seated = Seated(tmp_path)
    try:
        yield seated
    finally:
        if seated.app is not None:
            seated.app.close()


WRITES = '#!/bin/sh\necho "opened by ${0##*/}"\nfor last; do :; done\necho "# edited with $# words: $1" > "$last"\n'


@pytest.mark.parametrize("environ", [{}, {"EDITOR": ""}, {"EDITOR": " "}], ids=["unset", "empty", "blank"])
def test_without_an_editor_of_their_choice_the_one_that_is_there_opens(me: Seated, environ: dict[str, str]) -> None:
    me.installs("vi", WRITES)
    app = me.opens(**environ)
    app.press(b"E")
    app.until(b"opened by vi")
    app.until(b"# edited with 1 words")
    me.works_on()


def test_an_editor_with_arguments(me: Seated) -> None:
    me.installs("code", WRITES)
    app = me.opens(EDITOR="code -w")
    app.press(b"E")
    app.until(b"# edited with 2 words: -w")


@pytest.mark.parametrize(
    ("editor", "script", "told"),
    [
        ("no-such-editor", "", b"There is no program no-such-editor"),
        ("'unclosed", "", b"is not a command"),
        ("bad-interpreter", "#!/no/such/shell\n", b"cannot be started"),
        ("fails", "#!/bin/sh\nexit 3\n", b"fails ended with exit code 3"),
    ],
)
def test_an_editor_that_fails_is_told_in_the_app_which_goes_on(
    me: Seated, editor: str, script: str, told: bytes
) -> None:
    if script:
        me.installs(editor, script)
    app = me.opens(EDITOR=editor)
    app.press(b"E")
    app.until(told)
    me.works_on()


def there(*names: str) -> Callable[[str], str | None]:
    return lambda name: f"/usr/bin/{name}" if name in names else None


def test_which_editor_it_is() -> None:
    assert editor_command({"VISUAL": "code -w", "EDITOR": "nano"}, there("code", "nano")) == ["code", "-w"]
    assert editor_command({"VISUAL": "", "EDITOR": "nano"}, there("nano", "vi")) == ["nano"]
    assert editor_command({}, there("sensible-editor", "nano")) == ["sensible-editor"]
    assert editor_command({}, there("vim", "vi")) == ["vim"]
    with pytest.raises(EditorError, match="No editor is installed"):
        editor_command({}, there())


def test_what_an_editor_leaves_running_is_not_ours(me: Seated) -> None:
    """As VS Code does: the command ends, and its window is a daemon."""
    left = me.file.with_name("left")
    me.installs("ed", f"#!/bin/sh\n(sleep 60 & echo $! >{left}.new; mv {left}.new {left}) </dev/null\n")
    app = me.opens(EDITOR="ed", PATH=f"{me.programs}{os.pathsep}{os.environ['PATH']}")
    for _ in range(2):  # after the first, the app is again who gets orphans
        app.press(b"E")
        deadline = time.monotonic() + 30
        while not left.exists():
            assert time.monotonic() < deadline
            app.read(0.02)
        app.until(b"not checked yet", resumed=True)
        daemon = int(left.read_text())
        left.unlink()
        try:
            assert processes()[daemon].parent != app.pid
        finally:
            os.kill(daemon, signal.SIGKILL)
