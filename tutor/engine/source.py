"""What a learner's file says about itself: for the words of a diagnosis, never for a verdict."""

from __future__ import annotations

import ast
import re
import tokenize
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path

_NAME = re.compile(r"[\w.-]+")
MOST_FILES, MOST_BYTES = 20, 200_000
"""No diagnosis needs more source than this."""


def uncalled_main(path: Path) -> bool:
    """Whether the file defines a function `main` and calls it nowhere. False where it cannot be read or parsed."""
    tree = _parsed(path)
    defined = any(
        isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.name == "main" for node in tree.body
    )
    named = any(isinstance(node, ast.Name) and node.id == "main" for node in ast.walk(tree))
    return defined and not named


def launch_arguments(path: Path) -> tuple[str, ...]:
    """The names of the launch arguments that the file declares in plain words."""
    calls = [node for node in ast.walk(_parsed(path)) if isinstance(node, ast.Call)]
    names = []
    for call in calls:
        if ast.unparse(call.func).endswith("DeclareLaunchArgument"):
            given = [*call.args[:1], *(keyword.value for keyword in call.keywords if keyword.arg == "name")]
            names += [each.value for each in given if isinstance(each, ast.Constant) and isinstance(each.value, str)]
    return tuple(names)


def sources(path: Path) -> Mapping[str, str]:
    """The text of the file and of those beside it that it imports, by file name; what cannot be read is left out.

    Beside a launch file, those that it names are its programs, and other launch files.
    """
    found: dict[str, str] = {}
    waiting = [path]
    while waiting and len(found) < MOST_FILES:
        file = waiting.pop(0)
        if file.name in found or not file.is_file() or file.stat().st_size > MOST_BYTES:
            continue
        with suppress(OSError, SyntaxError, UnicodeError), tokenize.open(file) as opened:
            found[file.name] = opened.read()
        tree = _parsed(file)
        waiting += [path.parent / f"{name}.py" for name in (*_imported(tree), *_launched(tree))]
    return found


def _launched(tree: ast.Module) -> Iterator[str]:
    """The texts of a launch file, each of which may be the name of a file."""
    if any(isinstance(node, ast.FunctionDef) and node.name == "generate_launch_description" for node in tree.body):
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and _NAME.fullmatch(node.value):
                yield node.value.removesuffix(".py")


def _imported(tree: ast.Module) -> Iterator[str]:
    """The last parts of the names that are imported: of what lies beside the file, these are files."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            names = [alias.name for alias in node.names]
            yield from (name.rpartition(".")[2] for name in (*names, getattr(node, "module", None) or ""))


def _parsed(path: Path) -> ast.Module:
    """The file's syntax tree; an empty one where it cannot be read or parsed."""
    try:
        return ast.parse(path.read_bytes())
    except (OSError, SyntaxError, ValueError):
        return ast.Module([], [])
