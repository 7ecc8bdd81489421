"""I1.2: why gaps are reported wrongly or not at all, with lines and names of the learner's own file."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import replace

from checks.i1_2 import steps
from checks.i1_2.listener import find_listener
from checks.i1_2.parsing import find_misread
from checks.i1_2.rewriting import set_first_value
from tutor.judge import edits, source
from tutor.judge.source import Function, where
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

COMPARE = "compare each N with the one right before it, whether there was a gap or not"


def diagnose_alarm(trace: Trace, false: Sequence[str] = ()) -> Cause | None:
    """Why the node reports gaps where there are none. `false`: such log messages."""
    functions = source.callbacks(trace, "create_subscription")
    found = (
        _diagnose_misreading(trace, functions)
        or _diagnose_count_compared(trace, functions)
        or _diagnose_stale_number(trace, functions)
    )
    return _with_step(found, steps.compare_numbers(trace, false))


def diagnose_zero(trace: Trace) -> Cause:
    """Why the node does not report a jump from 0, though it reports others."""
    tested = next(filter(None, map(_find_truth_test, source.callbacks(trace, "create_subscription"))), None)
    text = "a jump from another number is noticed: 0 is false in Python, as None is"
    return Cause(
        "0 taken for no number",
        f"{text}, so that {where(tested)} is not true after N = 0" if tested else text,
        "ask whether there is a last number with “is None” or “is not None”, not by its truth value",
    )


def _find_truth_test(function: Function) -> ast.expr | None:
    """A variable that is tested for its truth value, and with which the function also compares or computes."""
    inside = list(ast.walk(function))
    used = {
        ast.unparse(each)
        for node in inside
        if isinstance(node, ast.Compare | ast.BinOp)
        for each in ast.iter_child_nodes(node)
        if isinstance(each, ast.Name | ast.Attribute)
    }
    for node in inside:
        tests = [node.test] if isinstance(node, ast.If | ast.IfExp) else []
        tests += node.values if isinstance(node, ast.BoolOp) else []
        for test in tests:
            tested = test.operand if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not) else test
            if isinstance(tested, ast.Name | ast.Attribute) and ast.unparse(tested) in used:
                return tested
    return None


def diagnose_no_messages(trace: Trace) -> Cause | None:
    """Why the node does not report a gap."""
    functions = source.callbacks(trace, "create_subscription")
    found = (
        _diagnose_misreading(trace, functions)
        or _diagnose_count_compared(trace, functions)
        or _diagnose_early_update(functions)
        or _diagnose_lower_only(functions)
    )
    return _with_step(found, steps.compare_numbers(trace))


def _with_step(found: Cause | None, step: str | None) -> Cause | None:
    return replace(found, hint=found.hint or step or COMPARE) if found else None


def _diagnose_misreading(trace: Trace, functions: Sequence[Function]) -> Cause | None:
    found = find_misread(functions)
    if found is None:
        return None
    step = _describe_edits(
        trace, found.node, [edits.replace_node(source.file_holding(trace, found.node).text, found.node, found.right)]
    )
    return Cause("number misread", found.text, step)


def _describe_edits(trace: Trace, node: ast.AST, change: Sequence[edits.Edit]) -> str:
    """The step that applies these edits to the file that contains this AST node; "" if there is no safe one."""
    return edits.describe_edits_of(source.file_holding(trace, node), change) or ""


def _diagnose_count_compared(trace: Trace, functions: Sequence[Function]) -> Cause | None:
    """Find a comparison of a message's number with the count of messages."""
    counters = _find_counters(trace)
    for function in functions:
        numbers = _find_numbers(function)
        for left, right, node in _operand_pairs(function):
            for number, other in () if _uses_operator(node, ast.Lt, ast.LtE) else ((left, right), (right, left)):
                counter = other.left if isinstance(other, ast.BinOp) else other
                if ast.unparse(number) in numbers and ast.unparse(counter) in counters:
                    return Cause(
                        "number compared with the count",
                        f"{where(node)} compares the N of a message with {ast.unparse(counter)}, how many have come: "
                        "these differ for anyone who starts late, and for good after a gap",
                        _compare_with_last(trace, function, node, ast.unparse(number)),
                    )
    return None


def _compare_with_last(trace: Trace, function: Function, node: ast.expr, number: str) -> str:
    """The step that replaces this comparison by one of the number with the previous number."""
    listener = find_listener(trace)
    if listener is None or not isinstance(node, ast.Compare):
        return ""
    last = listener.new_name("last_number", "number_before")
    test = f"{last} is not None and {number} > {last} + 1"
    before = set_first_value(listener, [f"{last} = None"])
    instead = edits.replace_node(source.file_holding(trace, node).text, node, test)
    return _describe_edits(trace, node, [before, instead, edits.append_to_function(function, f"{last} = {number}")])


def _diagnose_stale_number(trace: Trace, functions: Sequence[Function]) -> Cause | None:
    """Find a variable that numbers are compared with, but that is not updated after a gap."""
    for function in functions:
        for number, last, is_last, _ in _comparisons(function):
            right = f"{last} = {number if is_last else f'{number} + 1'}"
            if (why := _find_missing_update(trace, function, last, right)) is not None:
                text, change = why
                return Cause("false alarm", text, _describe_edits(trace, function, change))
    return None


def _find_missing_update(
    trace: Trace, function: Function, last: str, right: str
) -> tuple[str, list[edits.Edit]] | None:
    """Why `last` is not set for each message, and the edits that set it, by the statement `right`."""
    inside = list(ast.walk(function))
    at_end = [edits.append_to_function(function, right)]
    counted = next((each for each in inside if isinstance(each, ast.AugAssign) and _assigns_to(each, last)), None)
    if counted is not None:
        text = f"{where(counted)} keeps counting from before the gap, and never catches up"
        return text, [edits.replace_lines(counted.lineno, right)] if counted in function.body else at_end
    assignments = [each for each in inside if isinstance(each, ast.Assign) and _assigns_to(each, last)]
    if not assignments:
        return f"{last} is never set to the number of the message that came last", at_end
    always = [each for each in assignments if each in function.body]
    if not always:
        text = (
            f"{where(assignments[-1])} is not done for each message, only under a condition: {last} is outdated "
            "after a gap"
        )
        return text, at_end
    handled = [node for each in inside if isinstance(each, ast.ExceptHandler) for node in ast.walk(each)]
    ends = [
        each
        for each in inside
        if isinstance(each, ast.Return)
        and each.lineno < always[-1].lineno
        and not any(one in assignments for one in source.file_holding(trace, each).block_of(each))
    ]
    if not ends:
        return None
    end = next((each for each in ends if each not in handled), ends[0])  # messages without a number are rare
    text = f"line {end.lineno}: return leaves {function.name} before {where(always[-1])}"
    return text, [edits.insert_above(end.lineno, ast.unparse(always[-1]))]


def _diagnose_early_update(functions: Sequence[Function]) -> Cause | None:
    """Find a last number that is overwritten by the new one before the two are compared."""
    for function in functions:
        assignments = [each for each in function.body if isinstance(each, ast.Assign)]
        for number, last, _, node in _comparisons(function):
            for each in assignments:
                if each.lineno < node.lineno and _assigns_to(each, last) and ast.unparse(each.value) == number:
                    return Cause(
                        "gap not noticed",
                        f"{where(each)} comes before line {node.lineno} compares the two, so they are always the same",
                        "",
                    )
    return None


def _diagnose_lower_only(functions: Sequence[Function]) -> Cause | None:
    """Find a comparison that only detects lower numbers."""
    for function in functions:
        found = [(*each[:2], each[3]) for each in _comparisons(function) if isinstance(each[3], ast.Compare)]
        lower = [each for each in found if _uses_operator(each[2], ast.Lt, ast.LtE)]
        if not lower or any(not _uses_operator(each[2], ast.Lt, ast.LtE, ast.Is, ast.IsNot) for each in found):
            continue
        _, last, node = lower[0]
        if not any(_assigns_to(each, last) for each in function.body if each.lineno < node.lineno):
            return Cause(
                "gap not noticed", f"{where(node)} only detects lower numbers, and nothing checks for higher ones", ""
            )
    return None


def _uses_operator(node: ast.expr, *kinds: type[ast.cmpop]) -> bool:
    return isinstance(node, ast.Compare) and isinstance(node.ops[0], kinds)


def _find_counters(trace: Trace) -> set[str]:
    """The variables that are incremented by one, and otherwise only set to constants, never to a message's number."""
    assigned: dict[str, list[ast.expr]] = {}
    incremented: set[str] = set()
    for node in source.all_nodes(trace):
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
    found = {each.arg for each in function.args.args if each.arg in ("n", "num", "number", "seq", "index", "counter")}
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
    yield from sorted(found, key=lambda each: (each[2].lineno, each[2].col_offset))


def _comparisons(function: Function) -> Iterator[tuple[str, str, bool, ast.expr]]:
    """Each comparison of a message's number, as (number, other operand, whether that is the last N, AST node).

    If it is not the last N, it is the next one.
    """
    numbers = _find_numbers(function)
    for left, right, node in _operand_pairs(function):
        other = right if ast.unparse(left) in numbers else left if ast.unparse(right) in numbers else None
        number = left if other is right else right
        if other is None or (isinstance(node, ast.BinOp) and other is left):
            continue
        shift = isinstance(other, ast.BinOp) or isinstance(node, ast.BinOp)
        base = other.left if isinstance(other, ast.BinOp) else other
        if isinstance(base, ast.Attribute) and not base.attr.isupper():  # that would be a constant
            yield ast.unparse(number), ast.unparse(base), shift, node


def _assigns_to(node: ast.stmt, name: str) -> bool:
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AugAssign) else []
    return any(ast.unparse(target) == name for target in targets)
