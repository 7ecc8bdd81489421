"""What a learner's file says about itself: for the words of a diagnosis, never for a verdict."""

from __future__ import annotations

import ast
from pathlib import Path


def uncalled_main(path: Path) -> bool:
    """Whether the file defines a function `main` and calls it nowhere. False where it cannot be read or parsed."""
    try:
        tree = ast.parse(path.read_bytes())
    except (OSError, SyntaxError, ValueError):
        return False
    defined = any(
        isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.name == "main" for node in tree.body
    )
    named = any(isinstance(node, ast.Name) and node.id == "main" for node in ast.walk(tree))
    return defined and not named
