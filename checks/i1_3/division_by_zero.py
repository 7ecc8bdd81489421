"""I1.3: a division by zero that nothing is said of: where the server divides, and what to write there."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

from checks.i1_3.code import Code, learner_files
from tutor.judge import edits, source
from tutor.judge.edits import Edit
from tutor.judge.source import Function
from tutor.judge.trace import Trace

_SAYS = "error('division by zero')"
_DIVIDING = ("floordiv", "truediv", "divmod", "floor_divide", "Fraction")


@dataclass(frozen=True)
class _Place:
    """A division, with what is around it, from the inside out, each with the child that leads there."""

    code: Code
    node: ast.expr

    @property
    def around(self) -> list[tuple[ast.AST, ast.AST]]:
        outer = list(self.code.ancestors(self.node))
        return list(zip(outer, [self.node, *outer], strict=False))

    @property
    def function(self) -> Function | None:
        return self.code.function_around(self.node)


def log_division_by_zero(trace: Trace) -> str | None:
    """The step for a server that answers a division by zero, and logs no error: one more line where it knows of it."""
    places = [each for each in _divisions(trace) if f".{_SAYS}" not in each.code.text]
    for find in (_in_handler, _in_test, _plain):
        for place in places:
            edit = find(place, f"{place.code.node(place.node)}.get_logger()")
            if edit is not None and (step := place.code.as_step(edit)) is not None:
                return step
    for code in learner_files(trace):
        for handler in (each for each in code.nodes if isinstance(each, ast.ExceptHandler)):
            if handler.type is not None and "ZeroDivision" in ast.unparse(handler.type):
                step = code.as_step(_above(handler.body[0], f"{code.node(handler)}.get_logger().{_SAYS}"))
                if step is not None:
                    return step
    return None


def _divisions(trace: Trace) -> Iterator[_Place]:
    for code in learner_files(trace):
        for node in code.nodes:
            divides = isinstance(node, ast.BinOp) and isinstance(node.op, ast.FloorDiv | ast.Div)
            if isinstance(node, ast.expr) and (
                divides or (isinstance(node, ast.Call) and source.called_name(node) in _DIVIDING)
            ):
                yield _Place(code, node)


def _in_handler(place: _Place, log: str) -> Edit | None:
    """The division stands in a try: its except is the place."""
    for each, child in place.around:
        if isinstance(each, Function | ast.Lambda):
            return None
        if isinstance(each, ast.Try) and child in each.body and each.handlers:
            handler, first = each.handlers[0], each.handlers[0].body[0]
            if first.lineno != handler.lineno:
                return _above(first, f"{log}.{_SAYS}")
            rest = [ast.unparse(each) for each in handler.body if not isinstance(each, ast.Pass)]
            head = ast.unparse(ast.ExceptHandler(handler.type, handler.name, [ast.Pass()])).partition(":\n")[0]
            code = "\n    ".join([f"{head}:", f"{log}.{_SAYS}", *rest])
            return edits.replace_statement(handler, code)
    return None


def _above(first: ast.stmt, code: str) -> Edit:
    if isinstance(first, ast.Pass):
        return edits.replace_lines(first.lineno, code)
    return edits.insert_above(first.lineno, code)


def _in_test(place: _Place, log: str) -> Edit | None:
    """An if around the division, or above it in the same function, asks for zero: its branch is the place."""
    within = {id(each): child for each, child in place.around}
    tests = [each for each in ast.walk(place.function or ast.Module([], [])) if isinstance(each, ast.If)]
    for test in tests:
        asked = _asks_zero(test.test)
        divides_below = within.get(id(test)) in test.body
        if asked is None or (not asked and id(test) not in within) or (asked and divides_below):
            continue
        branch = test.body if asked else test.orelse
        if not branch:
            code = f"else:\n    {log}.{_SAYS}"
            return edits.insert_after(test, code)
        if branch[0].lineno != test.lineno:
            return _above(branch[0], f"{log}.{_SAYS}")
        return None
    return None


def _asks_zero(test: ast.expr) -> bool | None:
    """True where it holds for zero, False where it holds for anything else; None where it asks for neither."""
    match test:
        case ast.Compare(ops=[ast.Eq() | ast.NotEq() as how], left=left, comparators=[right]):
            zero = any(isinstance(each, ast.Constant) and each.value == 0 for each in (left, right))
            return isinstance(how, ast.Eq) if zero else None
        case ast.UnaryOp(op=ast.Not(), operand=ast.Name(id="b") | ast.Attribute(attr="b")):
            return True
        case ast.Name(id="b") | ast.Attribute(attr="b"):
            return False
    return None


def _plain(place: _Place, log: str) -> Edit | None:
    """Any other division in a statement: the test goes above it."""
    if any(isinstance(each, ast.Lambda) for each, _ in place.around) or place.function is None:
        return None
    statement = next(each for each in (child for _, child in place.around) if isinstance(each, ast.stmt))
    divisors = [each for each in ast.walk(statement) if isinstance(each, ast.Name | ast.Attribute)]
    by = next((each for each in divisors if (each.id if isinstance(each, ast.Name) else each.attr) == "b"), None)
    if by is None and isinstance(place.node, ast.BinOp):
        by = place.node.right if isinstance(place.node.right, ast.Name | ast.Attribute) else None
    if by is None:
        return None
    return edits.insert_above(statement.lineno, f"if {ast.unparse(by)} == 0:\n    {log}.{_SAYS}")
