"""Parse a learner's source, without the warnings that Python has for it."""

from __future__ import annotations

import ast
import warnings
from functools import lru_cache


def parse(text: str) -> ast.Module:
    """Parse Python code as `ast.parse` does, but without Python's warnings: the code is the learner's."""
    with warnings.catch_warnings(action="ignore", category=SyntaxWarning):
        return ast.parse(text)


class _WithoutAnnotations(ast.NodeTransformer):
    """Turns each annotated assignment in a function into a plain one, which is all that it is when it runs."""

    def __init__(self) -> None:
        self._in_function = False

    def visit_FunctionDef(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> ast.AST:
        outside, self._in_function = self._in_function, True
        self.generic_visit(node)
        self._in_function = outside
        return node

    visit_AsyncFunctionDef = visit_FunctionDef

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.AST:  # its annotations may mean something, as in a dataclass
        outside, self._in_function = self._in_function, False
        self.generic_visit(node)
        self._in_function = outside
        return node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST:
        if not self._in_function or node.value is None:
            return node
        return ast.copy_location(ast.Assign([node.target], node.value), node)


@lru_cache(maxsize=32)
def parsed(text: str) -> ast.Module:
    """The syntax tree of a learner's file, shared by equal texts; empty if Python cannot parse it.

    In functions, assignments have no annotations.
    """
    try:
        return _WithoutAnnotations().visit(parse(text))  # type: ignore[no-any-return]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])
