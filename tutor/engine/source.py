"""Read a learner's source files, for the wording of a diagnosis, never for a verdict."""

from __future__ import annotations

import ast
import io
import os
import re
import tokenize
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from tutor.judge.tracebacks import Frame
from tutor.source.tree import parse
from tutor.workspace.regular import read_regular

_NAME = re.compile(r"[\w.-]+")
_MAX_FILES, _MAX_BYTES = 20, 100_000
"""Limits on the number of files and the size of each; larger ones are not read. No diagnosis needs more source."""

_MAX_LIBRARY_BYTES = 1_000_000
"""Size limit of a file from which only single lines are shown."""

_MAX_TREE_DEPTH = 100
"""Files with deeper syntax trees are ignored: they would exhaust the stack of recursive visitors."""

_MAX_LINE_LENGTH = 2_000
"""Files with longer lines are ignored: a regular expression might take minutes on them."""


def trace_fields(path: Path) -> Mapping[str, Any]:
    """Return the fields of a `Trace` that come from the source of the file."""
    return {
        "uncalled_main": uncalled_main(path),
        "launch_arguments": launch_arguments(path),
        "sources": read_sources(path),
    }


def uncalled_main(path: Path) -> bool:
    """Whether the file defines a function `main` but never mentions it. False if it cannot be read or parsed."""
    tree = _parse_file(path)
    defined = any(
        isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.name == "main" for node in tree.body
    )
    mentioned = any(isinstance(node, ast.Name) and node.id == "main" for node in ast.walk(tree))
    return defined and not mentioned


def launch_arguments(path: Path) -> tuple[str, ...]:
    """Return the names of the launch arguments that the file declares with string literals."""
    calls = [node for node in ast.walk(_parse_file(path)) if isinstance(node, ast.Call)]
    names = []
    for call in calls:
        if ast.unparse(call.func).endswith("DeclareLaunchArgument"):
            given = [*call.args[:1], *(keyword.value for keyword in call.keywords if keyword.arg == "name")]
            names += [
                argument.value
                for argument in given
                if isinstance(argument, ast.Constant) and isinstance(argument.value, str)
            ]
    return tuple(names)


def read_sources(path: Path) -> Mapping[str, str]:
    """Map file names to source texts: those of the file and of the modules beside it that it imports.

    For a launch file, also those of the nodes and launch files beside it that it names. Unreadable files are left out.
    """
    found: dict[str, str] = {}
    pending = [path]
    while pending and len(found) < _MAX_FILES:
        file = pending.pop(0)
        if file.name in found or (text := _read_source(file)) is None:
            continue
        found[file.name] = text
        tree = _parse_file(file)
        pending += [path.parent / f"{name}.py" for name in (*_imported_names(tree), *_launched_names(tree))]
        pending += [
            path.parent / name for ending in _launched_endings(tree) for name in _names_ending_with(ending, path.parent)
        ]
    return found


def add_source_lines(frames: Collection[Frame]) -> tuple[Frame, ...]:
    """Add its source line to each frame of a stack dump; "" if that cannot be read.

    The paths are not to be trusted: a program can print a fake dump that names any file.
    """
    lines: dict[str, Sequence[str]] = {}
    for frame in frames:
        if frame.path not in lines and len(lines) < _MAX_FILES:
            lines[frame.path] = (_read_text(Path(frame.path), _MAX_LIBRARY_BYTES) or "").splitlines()
    return tuple(
        replace(frame, code="".join(lines.get(frame.path, ())[frame.line - 1 : frame.line]).strip()[:_MAX_LINE_LENGTH])
        for frame in frames
    )


def _launched_names(tree: ast.Module) -> Iterator[str]:
    """Yield the strings of a launch file that may be file names; nothing for other files."""
    return (text.removesuffix(".py") for text in _launch_strings(tree) if _NAME.fullmatch(text))


def _launched_endings(tree: ast.Module) -> Iterator[str]:
    """Yield the strings of a launch file that may end file names, as in `"node_" + role + ".py"`."""
    return (text for text in _launch_strings(tree) if text.endswith(".py"))


def _names_ending_with(ending: str, folder: Path) -> list[str]:
    """The names in a folder that have this ending."""
    try:
        return sorted(name for name in os.listdir(folder) if name.endswith(ending))
    except OSError:
        return []


def _launch_strings(tree: ast.Module) -> Iterator[str]:
    """Yield the strings of a launch file; nothing for other files."""
    if any(isinstance(node, ast.FunctionDef) and node.name == "generate_launch_description" for node in tree.body):
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                yield node.value


def _imported_names(tree: ast.Module) -> Iterator[str]:
    """Yield the last part of each imported name, which for a module beside the file is its file name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            names = [alias.name for alias in node.names]
            yield from (name.rpartition(".")[2] for name in (*names, getattr(node, "module", None) or ""))


def _parse_file(path: Path) -> ast.Module:
    """Return the file's syntax tree; an empty one if it cannot be read or parsed."""
    text = _read_source(path)
    return _parse(text) if text else ast.Module([], [])


def _read_source(path: Path) -> str | None:
    """Return the text of a file; None if it cannot be read, or exceeds a limit on time or memory."""
    text = _read_text(path, _MAX_BYTES)
    if text is None or max(map(len, text.splitlines()), default=0) > _MAX_LINE_LENGTH:
        return None
    try:
        return text if _depth(_parse(text)) <= _MAX_TREE_DEPTH else None
    except (RecursionError, MemoryError):
        return None


@lru_cache(maxsize=_MAX_FILES)
def _parse(text: str) -> ast.Module:
    """Return the syntax tree; an empty one on a syntax error. Raises RecursionError and MemoryError."""
    try:
        return parse(text)
    except (SyntaxError, ValueError):
        return ast.Module([], [])


def _depth(tree: ast.AST) -> int:
    depth, level = 0, [tree]
    while level:
        depth, level = depth + 1, [child for node in level for child in ast.iter_child_nodes(node)]
    return depth


def _read_text(path: Path, max_bytes: int) -> str | None:
    try:
        data = read_regular(path, max_bytes)
        if data is None:
            return None
        encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
        text = io.TextIOWrapper(io.BytesIO(data), encoding).read()
        text.encode()  # some encodings, such as unicode_escape, decode to surrogates
    except (LookupError, OSError, SyntaxError, ValueError):
        return None
    return text
