"""What a learner's file says about itself: for the words of a diagnosis, never for a verdict."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from tutor.judge.tracebacks import Frame
from tutor.workspace.regular import read_regular

_NAME = re.compile(r"[\w.-]+")
MOST_FILES, MOST_BYTES = 20, 100_000
"""No diagnosis needs more source than this: what is bigger is not read."""

MOST_BYTES_OF_LIBRARY = 1_000_000
"""Of a file that is only looked at for one of its lines."""

DEEPEST = 100
"""Nor such with a syntax tree deeper than this, which would exhaust the stack of those who walk it."""

LONGEST_LINE = 2_000
"""Nor such with longer lines, on which a pattern may take minutes."""


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
        if file.name in found or (text := _source(file)) is None:
            continue
        found[file.name] = text
        tree = _parsed(file)
        waiting += [path.parent / f"{name}.py" for name in (*_imported(tree), *_launched(tree))]
    return found


def with_code(frames: Collection[Frame]) -> tuple[Frame, ...]:
    """The frames of a stack dump, each with its line of source; empty where that cannot be read.

    A program may write what looks like a dump, and name any file in it.
    """
    lines: dict[str, Sequence[str]] = {}
    for frame in frames:
        if frame.path not in lines and len(lines) < MOST_FILES:
            lines[frame.path] = (_text(Path(frame.path), MOST_BYTES_OF_LIBRARY) or "").splitlines()
    return tuple(
        replace(frame, code="".join(lines.get(frame.path, ())[frame.line - 1 : frame.line]).strip()[:LONGEST_LINE])
        for frame in frames
    )


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
    text = _source(path)
    return _tree(text) if text else ast.Module([], [])


def _source(path: Path) -> str | None:
    """The text of a file; None where it cannot be read, or reading it would take too long or too much memory."""
    text = _text(path, MOST_BYTES)
    if text is None or max(map(len, text.splitlines()), default=0) > LONGEST_LINE:
        return None
    try:
        return text if _depth(_tree(text)) <= DEEPEST else None
    except (RecursionError, MemoryError):
        return None


@lru_cache(maxsize=MOST_FILES)
def _tree(text: str) -> ast.Module:
    """The syntax tree; an empty one where Python refuses the text. Raises RecursionError and MemoryError."""
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError):
        return ast.Module([], [])


def _depth(tree: ast.AST) -> int:
    depth, level = 0, [tree]
    while level:
        depth, level = depth + 1, [child for node in level for child in ast.iter_child_nodes(node)]
    return depth


def _text(path: Path, most: int) -> str | None:
    try:
        data = read_regular(path, most)
        if data is None:
            return None
        encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
        text = io.TextIOWrapper(io.BytesIO(data), encoding).read()
        text.encode()  # some encodings, such as unicode_escape, give what is not text
    except (LookupError, OSError, SyntaxError, ValueError):
        return None
    return text
