"""I1.2: how a learner's callback compares a message's number with the one before."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from tutor.source import Function, Program, SourceFile


def find_truth_test(function: Function, program: Program) -> ast.expr | None:
    """A variable that is tested for its truth value, and with which the function also compares or computes.

    Of a count of messages, 0 is rightly none.
    """
    inside, counters = list(ast.walk(function)), _find_counters(program)
    used = {
        ast.unparse(operand)
        for node in inside
        if isinstance(node, ast.Compare) or (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub))
        for operand in ast.iter_child_nodes(node)
        if isinstance(operand, ast.Name | ast.Attribute)
    }
    for node in inside:
        tests = [node.test] if isinstance(node, ast.If | ast.IfExp) else []
        tests += node.values if isinstance(node, ast.BoolOp) else []
        for test in tests:
            tested = test.operand if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not) else test
            if isinstance(tested, ast.Name | ast.Attribute) and ast.unparse(tested) in used - counters:
                return tested
    return None


def with_the_count(program: Program, functions: Sequence[Function]) -> Iterator[tuple[ast.expr, str]]:
    """The comparisons of a message's number with a count of messages: the expression, and the counter."""
    counters = _find_counters(program)
    for function in functions:
        numbers = _find_numbers(function)
        for left, right, node in _operand_pairs(function):
            for number, other in () if _uses_operator(node, ast.Lt, ast.LtE) else ((left, right), (right, left)):
                counter = other.left if isinstance(other, ast.BinOp) else other
                if ast.unparse(number) in numbers and ast.unparse(counter) in counters:
                    yield node, ast.unparse(counter)


def find_missing_update(function: Function, last: str, file: SourceFile) -> str:
    """Why `last` is not the number of the message before, in words that go on from "which"; "" if it is."""
    inside = list(ast.walk(function))
    counted = next(
        (statement for statement in inside if isinstance(statement, ast.AugAssign) and assigns_to(statement, last)),
        None,
    )
    if counted is not None:
        return f"line {counted.lineno} counts on from before the gap, and never catches up"
    assignments = [
        statement for statement in inside if isinstance(statement, ast.Assign) and assigns_to(statement, last)
    ]
    if not assignments:
        return "never gets the number of the message that came last"
    always = [assignment for assignment in assignments if assignment in function.body]
    if not always:
        return f"line {assignments[-1].lineno} sets under a condition only, not for each message"
    ends = [
        statement
        for statement in inside
        if isinstance(statement, ast.Return)
        and statement.lineno < always[-1].lineno
        and not any(one in assignments for one in file.block_of(statement))
    ]
    if not ends:
        return ""
    handled = [node for handler in inside if isinstance(handler, ast.ExceptHandler) for node in ast.walk(handler)]
    # What an exception handler leaves out does not matter: messages without a number are rare.
    end = next((statement for statement in ends if statement not in handled), ends[0])
    return f"line {always[-1].lineno} does not set where line {end.lineno} returns before it"


def find_lower_only(function: Function) -> ast.expr | None:
    """A comparison that finds lower numbers, if none finds higher ones."""
    found = [(last, node) for _, last, node in comparisons(function) if isinstance(node, ast.Compare)]
    lower = [(last, node) for last, node in found if _uses_operator(node, ast.Lt, ast.LtE)]
    if not lower or any(not _uses_operator(node, ast.Lt, ast.LtE, ast.Is, ast.IsNot) for _, node in found):
        return None
    last, node = lower[0]
    computed = (expression for expression in ast.walk(function) if isinstance(expression, ast.BinOp | ast.Call))
    if any(last in map(ast.unparse, ast.iter_child_nodes(expression)) for expression in computed):
        return None  # it computes with the last number, to find the missing ones
    early = any(assigns_to(statement, last) for statement in function.body if statement.lineno < node.lineno)
    return None if early else node


def comparisons(function: Function) -> Iterator[tuple[str, str, ast.expr]]:
    """Each comparison of a message's number with a kept one, as (number, kept one, syntax node)."""
    numbers = _find_numbers(function)
    for left, right, node in _operand_pairs(function):
        other = right if ast.unparse(left) in numbers else left if ast.unparse(right) in numbers else None
        number = left if other is right else right
        if other is None or (isinstance(node, ast.BinOp) and other is left):
            continue
        base = other.left if isinstance(other, ast.BinOp) else other
        if isinstance(base, ast.Attribute) and not base.attr.isupper():  # that would be a constant
            yield ast.unparse(number), ast.unparse(base), node


def assigns_to(node: ast.stmt, name: str) -> bool:
    """Whether a statement sets this variable."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AugAssign) else []
    return any(ast.unparse(target) == name for target in targets)


def _uses_operator(node: ast.expr, *kinds: type[ast.cmpop]) -> bool:
    return isinstance(node, ast.Compare) and isinstance(node.ops[0], kinds)


def _find_counters(program: Program) -> set[str]:
    """The variables that are incremented by one, and otherwise only set to constants, never to a message's number."""
    assigned: dict[str, list[ast.expr]] = {}
    incremented: set[str] = set()
    for node in program.nodes():
        if isinstance(node, ast.AugAssign):
            by_one = isinstance(node.op, ast.Add) and isinstance(node.value, ast.Constant) and node.value.value == 1
            incremented |= {ast.unparse(node.target)} if by_one else set()
        elif isinstance(node, ast.Assign):
            for target in node.targets:
                assigned.setdefault(ast.unparse(target), []).append(node.value)
    return {
        name
        for name in incremented
        if all(
            isinstance(value, ast.Constant) and isinstance(value.value, int) and value.value >= 0
            for value in assigned.get(name, [])
        )
    }


def _find_numbers(function: Function) -> set[str]:
    """The local variables and attributes that hold the number of the current message."""
    found = {
        parameter.arg
        for parameter in function.args.args
        if parameter.arg in ("n", "num", "number", "seq", "index", "counter")
    }
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and _is_made_by_int(node.value):
            found |= {ast.unparse(target) for target in node.targets}
    return found


def _is_made_by_int(value: ast.AST) -> bool:
    """Whether an expression is the result of int(), or is computed from it without another call."""
    if isinstance(value, ast.Call):
        return isinstance(value.func, ast.Name) and value.func.id == "int"
    return any(map(_is_made_by_int, ast.iter_child_nodes(value)))


def _operand_pairs(function: Function) -> Iterator[tuple[ast.expr, ast.expr, ast.expr]]:
    """The operands of each comparison or subtraction, with the expression itself, in source order."""
    found: list[tuple[ast.expr, ast.expr, ast.expr]] = []
    for node in ast.walk(function):
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            found.append((node.left, node.comparators[0], node))
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
            found.append((node.left, node.right, node))
    yield from sorted(found, key=lambda pair: (pair[2].lineno, pair[2].col_offset))
