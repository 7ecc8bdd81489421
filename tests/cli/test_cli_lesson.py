"""`ros-tutor lesson`: the text of an exercise, without its markup."""

from __future__ import annotations

import os
import re
import sys

import pytest

from tests.cli.conftest import Run
from tests.cli.terminals import run_in_terminals
from tutor.content import load_course

PROGRAM = "import sys; from tutor.cli import main; sys.exit(main(sys.argv[1:]))"


def test_every_lesson_is_readable_as_plain_text(run: Run) -> None:
    for lesson in load_course().lessons:
        result = run("lesson", lesson.id)
        assert (result.code, result.err) == (0, "")
        assert result.out.startswith(f"{lesson.id} {lesson.title} ({lesson.difficulty.value})\n")
        assert not re.search(r"\x1b|^```|^#+ |^\|", result.out, re.MULTILINE)
        for word in re.findall(r"\w+", lesson.body):
            assert word.lower() in result.out.lower() or word in ("python", "bash", "console", "text", "xml", "yaml")


def test_a_table_is_aligned_if_it_fits(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "  reliability  best effort      reliable         no\n" in run("lesson", "b1.1").out
    monkeypatch.setattr("tutor.cli.terminal.width", lambda stream: 60)
    narrow = run("lesson", "b1.1").out
    assert "- policy: reliability; offered: best effort; requested:\n  reliable; connected? no\n" in narrow
    assert all(len(line) <= 60 for line in narrow.splitlines() if not line.startswith("    "))


def test_on_a_terminal_headings_are_bold() -> None:
    env = {**os.environ, "TERM": "xterm-256color"}
    env.pop("NO_COLOR", None)
    arguments = [sys.executable, "-c", PROGRAM, "lesson", "b1.1"]
    code, out, _ = run_in_terminals(arguments, env)
    assert code == 0
    assert "\x1b[1mTASKS\x1b[0m" in out
    code, out, _ = run_in_terminals(arguments, {**env, "NO_COLOR": "1"})
    assert code == 0
    assert "\x1b" not in out


def test_start_names_it(run: Run) -> None:
    assert "  to read        ros-tutor lesson i1.1\n" in run("start", "i1.1").out
