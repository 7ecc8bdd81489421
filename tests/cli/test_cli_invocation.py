"""Printed commands can be typed as they are: `./ros-tutor` in a clone, `ros-tutor` where it is installed."""

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
CLONE = {invocation.STARTED_AS_VARIABLE: f"{os.getpid()} ./ros-tutor"}


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
        ({invocation.STARTED_AS_VARIABLE: f"{os.getppid()} ../ros-tutor"}, ["x"], "../ros-tutor"),
        ({invocation.STARTED_AS_VARIABLE: f"{os.getpid()} /a b/ros-tutor"}, ["x"], "'/a b/ros-tutor'"),
        ({invocation.STARTED_AS_VARIABLE: "1000000000 ./ros-tutor"}, ["x"], "ros-tutor"),  # set for another process
        ({invocation.STARTED_AS_VARIABLE: "damaged"}, ["x"], "ros-tutor"),
    ],
)
def test_the_program_name_is_the_word_that_was_typed(environ: dict[str, str], argv: list[str], word: str) -> None:
    assert invocation.detect_program_name(environ, argv) == word


def test_below_the_current_folder_the_program_name_is_a_short_path(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert invocation.detect_program_name({}, [str(home / "venv/bin/ros-tutor")]) == "venv/bin/ros-tutor"
    monkeypatch.setattr(shutil, "which", lambda name: str(home / "venv/bin/ros-tutor"))
    assert invocation.detect_program_name({}, [str(home / "venv/bin/ros-tutor")]) == "ros-tutor"


@pytest.mark.usefixtures("clone")
def test_a_clone_prints_commands_in_its_own_form(run: Run) -> None:
    assert "`./ros-tutor start i1.1` makes one" in run("list").err
    assert "Next: ./ros-tutor start i1.1" in run("list").out
    assert "Then: ./ros-tutor check i1.1\n" in run("start", "i1.1").out
    assert "usage: ./ros-tutor check" in run("check", "--help").out
    assert "(see `./ros-tutor check --help`)" in run("check").err
    assert "To tick one: ./ros-tutor checklist tick ITEM" in run("checklist").out
    assert "`./ros-tutor start i1.2` puts the skeleton there" in run("check", "i1.2").err
    for _ in range(4):
        result = run("hint", "i1.1")
    assert "`./ros-tutor solution i1.1`" in result.err


def test_a_clones_script_passes_on_how_it_was_called(tmp_path: Path) -> None:
    env = {**os.environ, "HOME": str(tmp_path)}
    for folder, word in ((ROOT, "./ros-tutor"), (ROOT / "docs", "../ros-tutor"), (tmp_path, str(ROOT / "ros-tutor"))):
        result = subprocess.run([word, "list"], cwd=folder, env=env, capture_output=True, text=True, check=True)
        assert f"Next: {word} start i1.1\n" in result.stdout


def test_an_installed_program_leaves_commands_in_a_text_as_they_are() -> None:
    text = "ros-tutor check i1.1\n$ ros-tutor hint i1.1\n`ros-tutor` and ros-tutor's folder, `ros-tutor list`"
    assert invocation.with_program_name(text) == text


@pytest.mark.usefixtures("clone")
def test_a_clone_replaces_the_commands_in_a_text() -> None:
    text = "ros-tutor check i1.1\n$ ros-tutor hint i1.1\n`ros-tutor` and ros-tutor's folder, `ros-tutor list`"
    assert invocation.with_program_name(text) == (
        "./ros-tutor check i1.1\n$ ./ros-tutor hint i1.1\n`./ros-tutor` and ros-tutor's folder, `./ros-tutor list`"
    )


def string_literals(source: Path) -> Iterator[tuple[int, str]]:
    """Yield the line and value of each string in a file that is not a docstring, if any names the program."""
    if "ros-tutor" not in (text := source.read_text()):
        return
    tree = ast.parse(text)
    docstrings = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
            yield node.lineno, node.value


def test_no_text_hard_codes_the_program_name() -> None:
    named = re.compile(rf"ros-tutor (?:{'|'.join(command_parsers(build()))}|--\w+)\b(?! exercises)")
    found = [
        f"{source.relative_to(ROOT)}:{line}: {text}"
        for source in sorted((ROOT / "tutor").rglob("*.py"))
        if "template" not in source.parts
        for line, text in string_literals(source)
        if named.search(text)
    ]
    assert found == []
