"""What the documentation shows can be typed and imported as it stands."""

from __future__ import annotations

import re
import shlex
import textwrap
from collections.abc import Iterator
from pathlib import Path

import pytest

from tutor.cli.parser import parse

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
CODE = re.compile(
    r"(?:^```(?P<language>\w*)\n(?P<fenced>.*?)^```$)|(?P<indented>(?:^ {4}.*\n|^\n(?= {4}))+)", re.M | re.S
)


def blocks(page: Path) -> Iterator[tuple[str, str]]:
    """Yield the language of each block of code ("" if it does not say) and the block."""
    for block in CODE.finditer(page.read_text(encoding="utf-8")):
        yield block["language"] or "", textwrap.dedent(block["fenced"] or block["indented"])


def commands(page: Path) -> Iterator[str]:
    """Yield each line of ros-tutor's own: without what is optional, and without the explanation beside it."""
    for _, text in blocks(page):
        for line in text.splitlines():
            if found := re.match(r"\s*(?:\./|\$ )?ros-tutor\b(?P<rest>.*)", line):
                rest = re.split(r"\s{3,}|\s+#|;| > ", found["rest"])[0]
                yield re.sub(r"\[[^]]*\]", "", rest).replace("|...", "").replace("...", "")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_can_be_typed(page: Path) -> None:
    for command in commands(page):
        words = [word.split("|")[0] for word in shlex.split(command)]
        parse(words)


def test_every_page_with_commands_is_found() -> None:
    assert {page.name for page in PAGES if list(commands(page))} >= {
        "README.md",
        "learning.md",
        "teaching.md",
        "authoring.md",
    }


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_python_is_python(page: Path) -> None:
    for language, text in blocks(page):
        if language == "python" or re.match(r"(from|import) \w", text):
            compile(text, str(page), "exec")
