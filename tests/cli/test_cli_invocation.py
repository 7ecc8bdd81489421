"""What is printed can be typed as it stands: `./ros-tutor` in a clone, `ros-tutor` where it is installed."""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

import tutor
from tests.cli.conftest import Run
from tutor import invocation
from tutor.cli.grammar import command_parsers
from tutor.cli.parser import build

ROOT = Path(tutor.__file__).parents[1]
CLONE = {invocation.VARIABLE: f"{os.getpid()} ./ros-tutor"}


@pytest.fixture
def clone(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in CLONE.items():
        monkeypatch.setenv(name, value)


@pytest.mark.parametrize(
    ("environ", "argv", "word"),
    [
        ({}, ["ros-tutor"], "ros-tutor"),
        ({}, ["/usr/lib/python3/pytest"], "ros-tutor"),
        ({}, [], "ros-tutor"),
        ({}, ["/opt/tools/bin/ros-tutor"], "/opt/tools/bin/ros-tutor"),
        ({}, ["/opt/my tools/ros-tutor"], "'/opt/my tools/ros-tutor'"),
        (CLONE, ["/work/.venv/bin/ros-tutor"], "./ros-tutor"),
        ({invocation.VARIABLE: f"{os.getppid()} ../ros-tutor"}, ["x"], "../ros-tutor"),
        ({invocation.VARIABLE: f"{os.getpid()} /a b/ros-tutor"}, ["x"], "'/a b/ros-tutor'"),
        ({invocation.VARIABLE: "1000000000 ./ros-tutor"}, ["x"], "ros-tutor"),  # that was in another terminal
        ({invocation.VARIABLE: "damaged"}, ["x"], "ros-tutor"),
    ],
)
def test_it_is_the_word_that_was_typed(environ: dict[str, str], argv: list[str], word: str) -> None:
    assert invocation.detect_program_name(environ, argv) == word


def test_below_the_current_folder_it_is_a_short_path(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert invocation.detect_program_name({}, [str(home / "venv/bin/ros-tutor")]) == "venv/bin/ros-tutor"
    monkeypatch.setattr(shutil, "which", lambda name: str(home / "venv/bin/ros-tutor"))
    assert invocation.detect_program_name({}, [str(home / "venv/bin/ros-tutor")]) == "ros-tutor"


@pytest.mark.usefixtures("clone")
def test_a_clone_prints_its_own_form(run: Run) -> None:
    assert "`./ros-tutor start i1.1` makes one" in run("list").err
    assert "Next: ./ros-tutor start i1.1" in run("list").out
    assert "Then: ./ros-tutor check i1.1\n" in run("start", "i1.1").out
    assert "usage: ./ros-tutor check" in run("check", "--help").out
    assert "(see `./ros-tutor check --help`)" in run("check").err
    assert "To tick one: ./ros-tutor checklist tick ITEM" in run("checklist").out
    assert "`./ros-tutor start i1.2` puts the skeleton there" in run("check", "i1.2").err
    for _ in range(4):
        ran = run("hint", "i1.1")
    assert "`./ros-tutor solution i1.1`" in ran.err


def test_a_clone_is_told_by_its_script(tmp_path: Path) -> None:
    env = {**os.environ, "HOME": str(tmp_path)}
    for folder, word in ((ROOT, "./ros-tutor"), (ROOT / "docs", "../ros-tutor"), (tmp_path, str(ROOT / "ros-tutor"))):
        ran = subprocess.run([word, "list"], cwd=folder, env=env, capture_output=True, text=True, check=True)
        assert f"Next: {word} start i1.1\n" in ran.stdout


def test_commands_in_a_text() -> None:
    text = "ros-tutor check i1.1\n$ ros-tutor hint i1.1\n`ros-tutor` and ros-tutor's folder, `ros-tutor list`"
    assert invocation.with_program_name(text) == text


@pytest.mark.usefixtures("clone")
def test_commands_in_a_text_of_a_clone() -> None:
    text = "ros-tutor check i1.1\n$ ros-tutor hint i1.1\n`ros-tutor` and ros-tutor's folder, `ros-tutor list`"
    assert invocation.with_program_name(text) == (
        "./ros-tutor check i1.1\n$ ./ros-tutor hint i1.1\n`./ros-tutor` and ros-tutor's folder, `./ros-tutor list`"
    )


def texts(source: Path) -> Iterator[tuple[int, str]]:
    """The texts in a file that are no docstrings."""
    tree = ast.parse(source.read_text())
    docs = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
            yield node.lineno, node.value


def test_no_text_names_a_command_in_a_form_of_its_own() -> None:
    named = re.compile(rf"ros-tutor (?:{'|'.join(command_parsers(build()))}|--\w+)\b(?! exercises)")
    found = [
        f"{source.relative_to(ROOT)}:{line}: {text}"
        for source in sorted((ROOT / "tutor").rglob("*.py"))
        if "template" not in source.parts
        for line, text in texts(source)
        if named.search(text)
    ]
    assert found == []
