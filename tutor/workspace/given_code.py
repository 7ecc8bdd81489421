"""Tells whether a learner has rewritten the code that the skeleton gives: only then does it show what they can do."""

from __future__ import annotations

import ast
import builtins
from collections import Counter
from collections.abc import Iterable, Iterator

from tutor.content import Lesson
from tutor.judge.submission import Submission
from tutor.workspace.regular import read_regular

_MAX_BYTES = 1_000_000


def given_criteria(lesson: Lesson, submission: Submission) -> tuple[str, ...]:
    """Return the ids of the criteria that the skeleton meets, and that this submission meets by the same code."""
    closed = [criterion for criterion in lesson.criteria if not criterion.open]
    if not closed:
        return ()
    own = skeleton = None
    for file in lesson.files[:1]:
        try:
            skeleton = file.skeleton.read_bytes()
            own = read_regular(submission.files[file.name], _MAX_BYTES)
        except (KeyError, OSError):
            pass
    if own is None or skeleton is None:
        return tuple(criterion.id for criterion in closed)
    return tuple(c.id for c in closed if not c.given or is_still_given(c.given, skeleton, own))


def is_still_given(function: str, skeleton: bytes, own: bytes) -> bool:
    """Whether every statement that the skeleton's `function` gives is still in `own`, whatever was added.

    Of a function with `try`, its `except` and `finally` blocks count: how it ends. Comments, docstrings, layout,
    nesting and the names that the file itself has chosen make no difference. A file that cannot be read has nothing
    of its own.
    """
    try:
        given_tree, own_tree = ast.parse(skeleton), ast.parse(own)
    except (SyntaxError, ValueError, RecursionError):
        return True
    found = next((node for node in ast.walk(given_tree) if getattr(node, "name", "") == function), None)
    if found is None:
        return True
    ends = any(isinstance(node, ast.Try) for node in ast.walk(found))
    given = Counter(_statements(_endings(found) if ends else [found], _imported(given_tree)))
    kept = Counter(_statements(_endings(own_tree) if ends else [own_tree], _imported(own_tree)))
    return given <= kept


def _endings(tree: ast.AST) -> Iterator[ast.AST]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Try):
            yield from node.handlers
            yield from node.finalbody


def _statements(nodes: Iterable[ast.AST], imported: frozenset[str]) -> Iterator[str]:
    """Yield each simple statement below the nodes, and each type of exception that is caught, as comparable text."""
    for node in (below for top in nodes for below in ast.walk(top)):
        if isinstance(node, ast.ExceptHandler):
            yield f"except {_text(node.type, imported) if node.type else ''}"
        elif isinstance(node, ast.stmt) and not hasattr(node, "body") and not _says_nothing(node):
            yield _text(node, imported)


def _says_nothing(node: ast.stmt) -> bool:
    """Whether this is a docstring, or `pass`; a `match` has its statements in its cases."""
    return isinstance(node, ast.Pass | ast.Match) or (
        isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    )


def _imported(tree: ast.AST) -> frozenset[str]:
    imports = (node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom))
    return frozenset(alias.asname or alias.name.partition(".")[0] for node in imports for alias in node.names)


def _text(node: ast.AST, imported: frozenset[str]) -> str:
    """Return a node as text in which the names that its file has chosen are numbered."""
    copy = ast.parse(ast.unparse(node))
    chosen: dict[str, str] = {}
    for name in ast.walk(copy):
        if isinstance(name, ast.Name) and name.id not in imported and not hasattr(builtins, name.id):
            name.id = chosen.setdefault(name.id, f"_{len(chosen)}")
    return ast.dump(copy)
