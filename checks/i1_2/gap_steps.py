"""I1.2: why gaps are told wrongly, or not at all, in the words of the learner's own file."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from checks.i1_2.parsing import Function, misread
from tutor.judge import source
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause


def of_alarm(trace: Trace) -> Cause | None:
    """Why it tells of gaps where there are none."""
    functions = source.callbacks(trace, "create_subscription")
    return misread(functions) or _from_the_count(trace, functions) or _not_followed(functions)


def of_silence(trace: Trace) -> Cause | None:
    """Why it tells nothing of a gap."""
    functions = source.callbacks(trace, "create_subscription")
    return (
        misread(functions) or _from_the_count(trace, functions) or _too_early(functions) or _only_backwards(functions)
    )


def _from_the_count(trace: Trace, functions: Sequence[Function]) -> Cause | None:
    """Whether a message's number is compared with how many have come."""
    counters = _counters(trace)
    for function in functions:
        numbers = _numbers(function)
        for left, right, node in _pairs(function):
            for number, other in () if _asks(node, ast.Lt, ast.LtE) else ((left, right), (right, left)):
                counter = other.left if isinstance(other, ast.BinOp) else other
                if ast.unparse(number) in numbers and ast.unparse(counter) in counters:
                    return _expected_of_count(function, node, ast.unparse(number), ast.unparse(counter))
    return None


def _expected_of_count(function: Function, node: ast.expr, number: str, counter: str) -> Cause:
    test = f"self.last_number is not None and {number} > self.last_number + 1"
    instead, more = test, ""
    if not isinstance(node, ast.Compare):
        instead = f"({number} - self.last_number - 1 if {test} else 0)"
        more = ", and log a warning where it is above 0"
    return Cause(
        "number compared with the count",
        f"{_at(node)} compares the N of a message with {counter}, how many have come: these differ for anyone who "
        "starts late, and for good after a gap",
        f"line {node.lineno}: write {instead} instead of {ast.unparse(node)}{more}\n"
        f"add to the end of {function.name}: self.last_number = {number}\n"
        "and to __init__: self.last_number = None",
    )


def _not_followed(functions: Sequence[Function]) -> Cause | None:
    """Whether what a number is compared with does not follow the numbers, once there was a gap."""
    for function in functions:
        for number, last, is_last, _ in _compared(function):
            if (why := _left_behind(function, last, number if is_last else f"{number} + 1")) is not None:
                return Cause("false alarm", *why)
    return None


def _left_behind(function: Function, last: str, right: str) -> tuple[str, str] | None:
    """Why `last` is not set to `right` with each message, and the step."""
    inside = list(ast.walk(function))
    counted = next((each for each in inside if isinstance(each, ast.AugAssign) and _sets(each, last)), None)
    if counted is not None:
        text = f"{_at(counted)} goes on counting from before the gap, and never follows it"
        if counted in function.body:
            return text, f"line {counted.lineno} becomes: {last} = {right}"
        return text, f"add to the end of {function.name}, outside of every if: {last} = {right}"
    kept = [each for each in inside if isinstance(each, ast.Assign) and _sets(each, last)]
    if not kept:
        text = f"{last} is never set to the number of the message that came last"
        return text, f"add to the end of {function.name}: {last} = {right}"
    always = [each for each in kept if each in function.body]
    if not always:
        return (
            f"{_at(kept[-1])} is not done for each message, only under a condition: after a gap {last} stays behind",
            f"add to the end of {function.name}, outside of every if: {last} = {right}",
        )
    end = next((each for each in inside if isinstance(each, ast.Return) and each.lineno < always[-1].lineno), None)
    if end is None:
        return None
    return (
        f"line {end.lineno}: return leaves {function.name} before {_at(always[-1])}",
        f"write above line {end.lineno}, with the same indentation: {ast.unparse(always[-1])}",
    )


def _too_early(functions: Sequence[Function]) -> Cause | None:
    """Whether the last number is replaced by the new one before the two are compared."""
    for function in functions:
        kept = [each for each in function.body if isinstance(each, ast.Assign)]
        for number, last, _, node in _compared(function):
            for each in kept:
                if each.lineno < node.lineno and _sets(each, last) and ast.unparse(each.value) == number:
                    return Cause(
                        "gap not noticed",
                        f"{_at(each)} comes before line {node.lineno} compares the two, and then they are always the "
                        "same",
                        f"move line {each.lineno}, {ast.unparse(each)}, to the end of {function.name}",
                    )
    return None


def _only_backwards(functions: Sequence[Function]) -> Cause | None:
    """Whether it looks for lower numbers only."""
    for function in functions:
        found = [(*each[:2], each[3]) for each in _compared(function) if isinstance(each[3], ast.Compare)]
        lower = [each for each in found if _asks(each[2], ast.Lt, ast.LtE)]
        if not lower or any(not _asks(each[2], ast.Lt, ast.LtE, ast.Is, ast.IsNot) for each in found):
            continue
        number, last, node = lower[0]
        if any(_sets(each, last) for each in function.body if each.lineno < node.lineno):
            continue
        return Cause(
            "gap not noticed",
            f"{_at(node)} is about lower numbers only, and nothing asks for higher ones",
            f"right after the line that reads {number}, with the same indentation:\n"
            f"if {last} is not None and {number} > {last} + 1:\n"
            f"    self.get_logger().warning(f'{{{number} - {last} - 1}} messages are missing')",
        )
    return None


def _asks(node: ast.expr, *kinds: type[ast.cmpop]) -> bool:
    return isinstance(node, ast.Compare) and isinstance(node.ops[0], kinds)


def _counters(trace: Trace) -> set[str]:
    """What is counted up by one for each message, and set to a plain number elsewhere: never to a message's."""
    set_to: dict[str, list[ast.expr]] = {}
    up: set[str] = set()
    for node in source.nodes(trace):
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


def _at(node: ast.expr | ast.stmt) -> str:
    """The line, and what it says there."""
    return f"line {node.lineno}: {ast.unparse(node)}"


def _sets(node: ast.stmt, name: str) -> bool:
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AugAssign) else []
    return any(ast.unparse(target) == name for target in targets)
