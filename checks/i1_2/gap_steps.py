"""I1.2: why gaps are reported wrongly, or not at all, in the words of the learner's own file."""

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
    """Why it reports gaps where there are none; `false`: log messages that do."""
    functions = source.callbacks(trace, "create_subscription")
    found = (
        _diagnose_misreading(trace, functions)
        or _diagnose_count_compared(trace, functions)
        or _diagnose_stale_number(trace, functions)
    )
    return _with_step(found, steps.compare_numbers(trace, false))


def diagnose_no_messages(trace: Trace) -> Cause | None:
    """Why it tells nothing of a gap."""
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
    step = _told(
        trace, found.node, [edits.replace_node(source.file_holding(trace, found.node).text, found.node, found.right)]
    )
    return Cause("number misread", found.text, step)


def _told(trace: Trace, node: ast.AST, change: Sequence[edits.Edit]) -> str:
    """The step that changes the file in which this node is; empty where none is sure."""
    return edits.describe_edits_of(source.file_holding(trace, node), change) or ""


def _diagnose_count_compared(trace: Trace, functions: Sequence[Function]) -> Cause | None:
    """Whether a message's number is compared with how many have come."""
    counters = _counters(trace)
    for function in functions:
        numbers = _numbers(function)
        for left, right, node in _pairs(function):
            for number, other in () if _asks(node, ast.Lt, ast.LtE) else ((left, right), (right, left)):
                counter = other.left if isinstance(other, ast.BinOp) else other
                if ast.unparse(number) in numbers and ast.unparse(counter) in counters:
                    return Cause(
                        "number compared with the count",
                        f"{where(node)} compares the N of a message with {ast.unparse(counter)}, how many have come: "
                        "these differ for anyone who starts late, and for good after a gap",
                        _with_the_last(trace, function, node, ast.unparse(number)),
                    )
    return None


def _with_the_last(trace: Trace, function: Function, node: ast.expr, number: str) -> str:
    """The step that compares a number with the one before it, in place of this comparison."""
    listener = find_listener(trace)
    if listener is None or not isinstance(node, ast.Compare):
        return ""
    last = listener.new("last_number", "number_before")
    test = f"{last} is not None and {number} > {last} + 1"
    before = set_first_value(listener, [f"{last} = None"])
    instead = edits.replace_node(source.file_holding(trace, node).text, node, test)
    return _told(trace, node, [before, instead, edits.append_to_function(function, f"{last} = {number}")])


def _diagnose_stale_number(trace: Trace, functions: Sequence[Function]) -> Cause | None:
    """Whether what a number is compared with does not follow the numbers, once there was a gap."""
    for function in functions:
        for number, last, is_last, _ in _compared(function):
            right = f"{last} = {number if is_last else f'{number} + 1'}"
            if (why := _left_behind(function, last, right)) is not None:
                text, change = why
                return Cause("false alarm", text, _told(trace, function, change))
    return None


def _left_behind(function: Function, last: str, right: str) -> tuple[str, list[edits.Edit]] | None:
    """Why `last` is not set with each message, and the edit that sets it: to what `right` says."""
    inside = list(ast.walk(function))
    at_end = [edits.append_to_function(function, right)]
    counted = next((each for each in inside if isinstance(each, ast.AugAssign) and _sets(each, last)), None)
    if counted is not None:
        text = f"{where(counted)} goes on counting from before the gap, and never follows it"
        return text, [edits.replace_lines(counted.lineno, right)] if counted in function.body else at_end
    kept = [each for each in inside if isinstance(each, ast.Assign) and _sets(each, last)]
    if not kept:
        return f"{last} is never set to the number of the message that came last", at_end
    always = [each for each in kept if each in function.body]
    if not always:
        text = (
            f"{where(kept[-1])} is not done for each message, only under a condition: after a gap {last} stays behind"
        )
        return text, at_end
    end = next((each for each in inside if isinstance(each, ast.Return) and each.lineno < always[-1].lineno), None)
    if end is None:
        return None
    text = f"line {end.lineno}: return leaves {function.name} before {where(always[-1])}"
    return text, [edits.insert_above(end.lineno, ast.unparse(always[-1]))]


def _diagnose_early_update(functions: Sequence[Function]) -> Cause | None:
    """Whether the last number is replaced by the new one before the two are compared."""
    for function in functions:
        kept = [each for each in function.body if isinstance(each, ast.Assign)]
        for number, last, _, node in _compared(function):
            for each in kept:
                if each.lineno < node.lineno and _sets(each, last) and ast.unparse(each.value) == number:
                    return Cause(
                        "gap not noticed",
                        f"{where(each)} comes before line {node.lineno} compares the two, and then they are always the "
                        "same",
                        "",
                    )
    return None


def _diagnose_lower_only(functions: Sequence[Function]) -> Cause | None:
    """Whether it looks for lower numbers only."""
    for function in functions:
        found = [(*each[:2], each[3]) for each in _compared(function) if isinstance(each[3], ast.Compare)]
        lower = [each for each in found if _asks(each[2], ast.Lt, ast.LtE)]
        if not lower or any(not _asks(each[2], ast.Lt, ast.LtE, ast.Is, ast.IsNot) for each in found):
            continue
        _, last, node = lower[0]
        if not any(_sets(each, last) for each in function.body if each.lineno < node.lineno):
            return Cause(
                "gap not noticed", f"{where(node)} is about lower numbers only, and nothing asks for higher ones", ""
            )
    return None


def _asks(node: ast.expr, *kinds: type[ast.cmpop]) -> bool:
    return isinstance(node, ast.Compare) and isinstance(node.ops[0], kinds)


def _counters(trace: Trace) -> set[str]:
    """What is counted up by one for each message, and set to a plain number elsewhere: never to a message's."""
    set_to: dict[str, list[ast.expr]] = {}
    up: set[str] = set()
    for node in source.all_nodes(trace):
        if isinstance(node, ast.AugAssign):
            one = isinstance(node.op, ast.Add) and isinstance(node.value, ast.Constant) and node.value.value == 1
            up |= {ast.unparse(node.target)} if one else set()
        elif isinstance(node, ast.Assign):
            for target in node.targets:
                set_to.setdefault(ast.unparse(target), []).append(node.value)
    return {
        name
        for name in up
        if all(
            isinstance(value, ast.Constant) and isinstance(value.value, int) and value.value >= 0
            for value in set_to.get(name, [])
        )
    }


def _numbers(function: Function) -> set[str]:
    """The local names, and attributes, that hold the number of the message that has just come."""
    found = {each.arg for each in function.args.args if each.arg in ("n", "num", "number", "seq", "index", "counter")}
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and any(
            isinstance(each, ast.Call) and isinstance(each.func, ast.Name) and each.func.id == "int"
            for each in ast.walk(node.value)
        ):
            found |= {ast.unparse(target) for target in node.targets}
    return found


def _pairs(function: Function) -> Iterator[tuple[ast.expr, ast.expr, ast.expr]]:
    """What is compared with, or subtracted from, each other; with the comparison or difference, in written order."""
    found: list[tuple[ast.expr, ast.expr, ast.expr]] = []
    for node in ast.walk(function):
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            found.append((node.left, node.comparators[0], node))
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
            found.append((node.left, node.right, node))
    yield from sorted(found, key=lambda each: (each[2].lineno, each[2].col_offset))


def _compared(function: Function) -> Iterator[tuple[str, str, bool, ast.expr]]:
    """The message's number, what it is compared with, whether the latter is the last N (or the next one), and where."""
    numbers = _numbers(function)
    for left, right, node in _pairs(function):
        other = right if ast.unparse(left) in numbers else left if ast.unparse(right) in numbers else None
        number = left if other is right else right
        if other is None or (isinstance(node, ast.BinOp) and other is left):
            continue
        shift = isinstance(other, ast.BinOp) or isinstance(node, ast.BinOp)
        base = other.left if isinstance(other, ast.BinOp) else other
        if isinstance(base, ast.Attribute):
            yield ast.unparse(number), ast.unparse(base), shift, node


def _sets(node: ast.stmt, name: str) -> bool:
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AugAssign) else []
    return any(ast.unparse(target) == name for target in targets)
