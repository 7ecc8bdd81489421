"""Slips of plain Python that behave wrongly without an exception, found by the learner's source, with the step."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge import source
from tutor.judge.trace import Trace

_TRUTHS = {"true": True, "1": True, "on": True, "false": False, "0": False, "off": False}


def truth_as_text(trace: Trace) -> str | None:
    """The step where a parameter's value, which is True or False, is compared with a text such as 'true'."""
    for node in source.nodes(trace):
        match node:
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as how], comparators=[right]):
                pass
            case _:
                continue
        sides = (left, right) if isinstance(right, ast.Constant) else (right, left)
        of, text = sides
        if not (isinstance(text, ast.Constant) and isinstance(text.value, str)):
            continue
        truth, value = _TRUTHS.get(text.value.lower()), _value(of)
        if truth is None or value is None:
            continue
        right_way = truth is isinstance(how, ast.Eq)
        return (
            f"in line {node.lineno}, write {'' if right_way else 'not '}{ast.unparse(value)} in place of "
            f"{ast.unparse(node)}: the value is True or False, and no text"
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


def late_binding(trace: Trace) -> str | None:
    """The step where a lambda made in a loop uses the loop's variables, which have their last values when it runs."""
    for loop in (node for node in source.nodes(trace) if isinstance(node, ast.For)):
        names = {node.id for node in ast.walk(loop.target) if isinstance(node, ast.Name)}
        for each in _lambdas(loop):
            own = {argument.arg for argument in (*each.args.args, *each.args.kwonlyargs)}
            used = [node.id for node in ast.walk(each.body) if isinstance(node, ast.Name)]
            late = [name for name in dict.fromkeys(used) if name in names - own]
            if late and each.args.vararg is None:
                given = ast.unparse(each.args)
                kept = ", ".join(f"{name}={name}" for name in late)
                return (
                    f"in line {each.lineno}, write lambda {f'{given}, ' if given else ''}{kept}: "
                    f"{ast.unparse(each.body)}\n"
                    f"(without {kept}, every lambda of the loop has the last {late[0]})"
                )
    return None


def _lambdas(loop: ast.For) -> Iterator[ast.Lambda]:
    return (node for statement in loop.body for node in ast.walk(statement) if isinstance(node, ast.Lambda))


def nanoseconds(trace: Trace) -> str | None:
    """The step where nanoseconds are taken for seconds, or divided by another number than 1e9."""
    scaled = False
    for node in source.nodes(trace):
        match node:
            case ast.BinOp(left=left, op=ast.Div(), right=ast.Constant(value=int() | float() as by)) if _nano(left):
                if by != 1e9:
                    right = f"{ast.unparse(left)} / 1e9"
                    return f"in line {node.lineno}, write {right} in place of {ast.unparse(node)}: a second has 1e9"
                scaled = True
            case ast.BinOp(op=ast.Div() | ast.Mult(), right=ast.Constant(value=int() | float() as by)):
                scaled = scaled or by >= 1e3 or by <= 1e-3
    for node in source.nodes(trace):
        if isinstance(node, ast.Attribute) and node.attr == "nanoseconds" and not scaled:
            return f"in line {node.lineno}, write ({ast.unparse(node)} / 1e9) in place of {ast.unparse(node)}"
    return None


def _nano(expression: ast.expr) -> bool:
    return any(isinstance(node, ast.Attribute) and node.attr == "nanoseconds" for node in ast.walk(expression))
