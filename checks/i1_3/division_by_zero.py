"""I1.3: the step for a division by zero that the server does not report: where it divides, and what to log there."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass

from checks.i1_3.code import Code, learner_files
from tutor.judge import edits, source
from tutor.judge.edits import Edit
from tutor.judge.source import Function
from tutor.judge.trace import Trace

_LOG_CALL = "error('division by zero')"
_ZERO_DIVISION = {"ZeroDivisionError", "ArithmeticError"}
_BROAD = {"Exception", "BaseException"}
_DIVISION_FUNCTIONS = ("floordiv", "truediv", "divmod", "floor_divide", "Fraction")


@dataclass(frozen=True)
class _Division:
    """A division in the learner's code."""

    code: Code
    node: ast.expr

    @property
    def around(self) -> list[tuple[ast.AST, ast.AST]]:
        """The enclosing nodes from the inside out, each with its child that contains the division."""
        outer = list(self.code.ancestors(self.node))
        return list(zip(outer, [self.node, *outer], strict=False))

    @property
    def function(self) -> Function | None:
        return self.code.function_around(self.node)


def log_division_by_zero(trace: Trace) -> str | None:
    """Step: log an error where a server that answers a division by zero handles it."""
    divisions = [
        each
        for each in _find_divisions(trace)
        if f".{_LOG_CALL}" not in each.code.text and each.code.has_node(each.node)
    ]
    for propose in (_log_in_handler, _log_in_zero_branch, _insert_test):
        for division in divisions:
            edit = propose(division, f"{division.code.node_name(division.node)}.get_logger()")
            if edit is not None and (step := division.code.as_step(edit)) is not None:
                return step
    for kinds in (_ZERO_DIVISION, _BROAD):
        for code in learner_files(trace):
            for handler in (each for each in code.nodes if isinstance(each, ast.ExceptHandler) and code.has_node(each)):
                if source.calls_in(handler, "warn", "warning", "error", "fatal"):  # it never runs, it seems
                    continue
                if kinds & set(re.findall(r"\w+", ast.unparse(handler.type) if handler.type else "BaseException")):
                    log = f"{code.node_name(handler)}.get_logger().{_LOG_CALL}"
                    if (step := code.as_step(_insert_above(handler.body[0], log))) is not None:
                        return step
    return None


def return_zero(trace: Trace) -> str | None:
    """Step: let a node's method that returns the quotient of two numbers log an error and return 0."""
    for division in _find_divisions(trace):
        code, node, function = division.code, division.node, division.function
        returned = next((each for each, _ in division.around if isinstance(each, ast.stmt)), None)
        parameters = {each.arg for each in function.args.args} if isinstance(function, ast.FunctionDef) else set()
        if not (isinstance(returned, ast.Return) and isinstance(node, ast.BinOp)):
            continue
        around = next((each for each in code.ancestors(node) if isinstance(each, ast.ClassDef)), None)
        logger = f"{code.self_name(node)}.get_logger()"
        logs = around is not None and logger in ast.unparse(around)  # its base class may be in another file
        if isinstance(node.right, ast.Name) and node.right.id in parameters and (logs or code.node_method(node)):
            guard = f"if {node.right.id} == 0:\n    {logger}.{_LOG_CALL}\n    return 0"
            if (step := code.as_step(edits.insert_above(returned.lineno, guard))) is not None:
                return step
    return None


def _find_divisions(trace: Trace) -> Iterator[_Division]:
    for code in learner_files(trace):
        for node in code.nodes:
            divides = isinstance(node, ast.BinOp) and isinstance(node.op, ast.FloorDiv | ast.Div)
            if isinstance(node, ast.expr) and (
                divides or (isinstance(node, ast.Call) and source.called_name(node) in _DIVISION_FUNCTIONS)
            ):
                yield _Division(code, node)


def _log_in_handler(division: _Division, log: str) -> Edit | None:
    """If the division is in a `try`, log in its first `except`."""
    for each, child in division.around:
        if isinstance(each, Function | ast.Lambda):
            return None
        if isinstance(each, ast.Try) and child in each.body and each.handlers:
            handler, first = each.handlers[0], each.handlers[0].body[0]
            if first.lineno != handler.lineno:
                return _insert_above(first, f"{log}.{_LOG_CALL}")
            rest = [ast.unparse(each) for each in handler.body if not isinstance(each, ast.Pass)]
            head = ast.unparse(ast.ExceptHandler(handler.type, handler.name, [ast.Pass()])).partition(":\n")[0]
            code = "\n    ".join([f"{head}:", f"{log}.{_LOG_CALL}", *rest])
            return edits.replace_statement(handler, code)
    return None


def _insert_above(first: ast.stmt, code: str) -> Edit:
    if isinstance(first, ast.Pass):
        return edits.replace_lines(first.lineno, code)
    return edits.insert_above(first.lineno, code)


def _log_in_zero_branch(division: _Division, log: str) -> Edit | None:
    """If an `if` around the division, or elsewhere in the same function, tests for zero, log in its zero branch."""
    within = {id(each): child for each, child in division.around}
    tests = [each for each in ast.walk(division.function or ast.Module([], [])) if isinstance(each, ast.If)]
    for test in tests:
        is_zero = _tests_for_zero(test.test)
        divides_in_body = within.get(id(test)) in test.body
        if is_zero is None or (not is_zero and id(test) not in within) or (is_zero and divides_in_body):
            continue
        branch = test.body if is_zero else test.orelse
        if not branch:
            code = f"else:\n    {log}.{_LOG_CALL}"
            return edits.insert_after(test, code)
        if branch[0].lineno != test.lineno:
            return _insert_above(branch[0], f"{log}.{_LOG_CALL}")
        return None
    return None


def _tests_for_zero(test: ast.expr) -> bool | None:
    """Return True if a condition holds for zero only, False if for all but zero, None if it is about something else."""
    match test:
        case ast.Compare(ops=[ast.Eq() | ast.NotEq() as operator], left=left, comparators=[right]):
            with_zero = any(isinstance(each, ast.Constant) and each.value == 0 for each in (left, right))
            return isinstance(operator, ast.Eq) if with_zero else None
        case ast.UnaryOp(op=ast.Not(), operand=ast.Name(id="b") | ast.Attribute(attr="b")):
            return True
        case ast.Name(id="b") | ast.Attribute(attr="b"):
            return False
    return None


def _insert_test(division: _Division, log: str) -> Edit | None:
    """For any other division, insert a test for zero above its statement."""
    if any(isinstance(each, ast.Lambda) for each, _ in division.around) or division.function is None:
        return None
    statement = next(each for each in (child for _, child in division.around) if isinstance(each, ast.stmt))
    names = [each for each in ast.walk(statement) if isinstance(each, ast.Name | ast.Attribute)]
    divisor = next((each for each in names if (each.id if isinstance(each, ast.Name) else each.attr) == "b"), None)
    if divisor is None and isinstance(division.node, ast.BinOp):
        divisor = division.node.right if isinstance(division.node.right, ast.Name | ast.Attribute) else None
    if divisor is None:
        return None
    return edits.insert_above(statement.lineno, f"if {ast.unparse(divisor)} == 0:\n    {log}.{_LOG_CALL}")
