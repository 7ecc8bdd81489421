"""Where a file declares and reads parameters, and which function is which parameter callback."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from tutor.source.file import Function
from tutor.source.node import NodeFile
from tutor.source.patterns import argument

ON_SET = "add_on_set_parameters_callback"
POST_SET = "add_post_set_parameters_callback"
PRE_SET = "add_pre_set_parameters_callback"
DECLARE = ("declare_parameter", "declare_parameters")

_READ_CALLS = {"get_parameter", "get_parameter_or", "declare_parameter"}


def is_text(node: ast.expr | None, text: str) -> bool:
    """Whether this is the given string."""
    return isinstance(node, ast.Constant) and node.value == text


def constants(nodes: Sequence[ast.AST]) -> Iterator[object]:
    """The values of all constants in these syntax trees."""
    for node in nodes:
        yield from (part.value for part in ast.walk(node) if isinstance(part, ast.Constant))


def reads(node: ast.AST, name: str) -> bool:
    """Whether this is `node.get_parameter(name).value`, or an equivalent expression."""
    if not isinstance(node, ast.Attribute) or not node.attr.endswith("value"):
        return False
    inner: ast.expr = node.value
    while isinstance(inner, ast.Attribute | ast.Call):
        if isinstance(inner, ast.Call) and isinstance(inner.func, ast.Attribute) and inner.func.attr in _READ_CALLS:
            return is_text(argument(inner, "name"), name)
        inner = inner.func if isinstance(inner, ast.Call) else inner.value
    return False


def readings(file: NodeFile, name: str) -> list[ast.expr]:
    """The expressions that read a parameter's value from the node."""
    return [node for node in ast.walk(file.tree) if isinstance(node, ast.expr) and reads(node, name)]


def kept_value(file: NodeFile, name: str) -> ast.Assign | ast.AnnAssign | None:
    """The first assignment that keeps a parameter's value, or something computed from it."""
    for node in ast.walk(file.tree):
        if (
            isinstance(node, ast.Assign | ast.AnnAssign)
            and node.value is not None
            and any(reads(inner, name) for inner in ast.walk(node.value))
        ):
            return node
    return None


def copied_once(file: NodeFile, name: str) -> ast.Assign | ast.AnnAssign | None:
    """The assignment that keeps a parameter's value when the node is set up, if no other one changes that copy."""
    kept = kept_value(file, name)
    if kept is None or file.function_around(kept) is not file.setup or file.calls("setattr"):
        return None
    target = kept.targets[0] if isinstance(kept, ast.Assign) else kept.target
    if not isinstance(target, ast.Attribute):
        return None
    stored = [node for node in file.nodes if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)]
    return kept if [node.attr for node in stored].count(target.attr) == 1 else None


def registered_callback(file: NodeFile, kind: str) -> Function | None:
    """The function that is registered as a parameter callback of this kind, such as `ON_SET`; None if none is."""
    for call in file.calls(kind):
        given = argument(call, "callback")
        if not isinstance(given, ast.Lambda | ast.Call) and (found := file.function(given)) is not None:
            return found
    return None


def may_refuse(file: NodeFile, function: Function | None) -> bool:
    """Whether a function, or one that it calls, makes a SetParametersResult that refuses."""
    if function is None:
        return False
    return any("successful=False" in ast.unparse(reached).replace(" ", "") for reached in file.reachable_from(function))
