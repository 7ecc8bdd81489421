"""Slips of plain Python that behave wrongly without an exception, found by the learner's source, with the step."""

from __future__ import annotations

import ast

from tutor.judge import edits, source
from tutor.judge.trace import Trace

_TRUTHS = {"true": True, "1": True, "on": True, "false": False, "0": False, "off": False}


def boolean_compared_with_text(trace: Trace) -> str | None:
    """The step where a parameter's value, which is True or False, is compared with a text such as 'true'."""
    for node in source.syntax_nodes(trace.sources.get(trace.file, "")):
        match node:
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as how], comparators=[right]):
                pass
            case _:
                continue
        of, said = (left, right) if isinstance(right, ast.Constant) else (right, left)
        if not (isinstance(said, ast.Constant) and isinstance(said.value, str)):
            continue
        truth, value = _TRUTHS.get(said.value.lower()), _value(of)
        if truth is None or value is None:
            continue
        text = trace.sources.get(trace.file, "")
        right_way = truth is isinstance(how, ast.Eq)
        return edits.describe_edits(
            text, edits.replace_node(text, node, f"{'' if right_way else 'not '}{ast.unparse(value)}")
        )
    return None


def _value(expression: ast.expr) -> ast.expr | None:
    """The `x.value` in `x.value` or `str(x.value)`; `str(x.value).lower()` goes well."""
    match expression:
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            return _value(inner)
        case ast.Attribute(attr="value" | "bool_value"):
            return expression
    return None
