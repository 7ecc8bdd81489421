"""`ros-tutor grade` on the command line: wrong usage, a class for real, and merging results."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.terminals import run_in_terminals
from tutor.content import load_course

COURSE = load_course()


def grade(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    argv = [sys.executable, "-m", "tutor", "grade", *map(str, arguments)]
    return subprocess.run(argv, capture_output=True, text=True, check=False, timeout=110)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "SUBMISSIONS"),
        (("nowhere",), "there is no nowhere"),
        ((".", "--shard", "9/8"), "3/8"),
        ((".", "--jobs", "0"), "at least one"),
        ((".", "--format", "gif"), "gif"),
        (("--collect", "."), "--output"),
    ],
)
def test_wrong_usage(arguments: tuple[str, ...], words: str) -> None:
    done = grade(*arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert not done.stdout


def test_a_class_is_graded_and_kept(tmp_path: Path) -> None:
    lesson = COURSE.find("i1.3")
    shutil.copytree(lesson.files[0].solution.parent, tmp_path / "class/ada")
    (tmp_path / "class/bob").mkdir()
    (tmp_path / "class/bob/calculator.py").write_text("print()\n")
    first = grade(tmp_path / "class", "--no-isolation", "--output", tmp_path / "results", "--format", "csv")
    assert first.returncode == 0, first.stderr
    rows = first.stdout.splitlines()
    assert rows[1].startswith("ada,ada,,,i1.3,passed,10,10,")
    assert rows[2].startswith("bob,bob,,,i1.3,missing,0,10,")
    document = json.loads((tmp_path / "results/ada/i1.3.json").read_text())
    assert (document["schema"], document["status"]) == ("ros-tutor/result/1", "passed")
    assert document["cpu_s"] > 0

    again = grade(tmp_path / "class", "--output", tmp_path / "results", "--format", "csv")
    assert again.stdout == first.stdout
    assert "1 of them judged before" in again.stderr
    merged = grade("--collect", tmp_path / "results", "--output", tmp_path / "all", "--format", "csv")
    assert merged.stdout == first.stdout


def test_on_a_terminal_a_table_is_drawn_and_the_report_follows(tmp_path: Path) -> None:
    (tmp_path / "class/bob").mkdir(parents=True)
    argv = [sys.executable, "-m", "tutor", "grade", str(tmp_path / "class"), "--exercise", "i1.3"]
    code, out, err = run_in_terminals(argv, {**os.environ, "TERM": "xterm-256color"})
    assert code == 0, err
    assert "nothing was handed in" in err
    assert "1 of 1" in err
    assert "0 of 10" in out
