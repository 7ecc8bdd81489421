"""What a learner's file says about itself: for the words of a diagnosis, never for a verdict."""

from __future__ import annotations

import ast
from pathlib import Path


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


def _parsed(path: Path) -> ast.Module:
    """The file's syntax tree; an empty one where it cannot be read or parsed."""
    try:
        return ast.parse(path.read_bytes())
    except (OSError, SyntaxError, ValueError):
        return ast.Module([], [])
