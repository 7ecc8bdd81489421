"""I1.3: edits of the client's code as a program: that it makes all four calls, and ends with 0."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from checks.i1_3.code import Code
from checks.i1_3.facts import SIGNS
from checks.i1_3.services import Changes
from tutor.judge import edits, source
from tutor.judge.source import Function

_DEFINES = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef
_EXITS = "exit", "_exit", "quit", "SystemExit"


def add_to_list(code: Code, missing: Sequence[str]) -> str | None:
    """The step that puts the services that are not called into the list of those that are."""
    for each in code.nodes:
        items = each.elts if isinstance(each, ast.Tuple | ast.List) else []
        names = {str(found.value).strip("/"): (found, item) for item in items for found in _first_text(item)}
        if len(names) >= 2 and all(f"/{name}" in SIGNS for name in names):
            text, item = list(names.values())[-1]
            like = str(text.value)
            written = ast.unparse(item)
            new = [written.replace(repr(like), repr(like.replace(like.strip("/"), name[1:]))) for name in missing]
            return code.as_step(edits.replace_node(code.text, item, ", ".join([written, *new])))
    return None


def _first_text(item: ast.expr) -> Iterator[ast.Constant]:
    if isinstance(item, ast.Tuple | ast.List) and item.elts:
        item = item.elts[0]
    if isinstance(item, ast.Constant) and isinstance(item.value, str):
        yield item


def join_thread(code: Code) -> str | None:
    """The step by which a program waits at its end for a thread that spins, which ends when ROS is shut down."""
    change = Changes(code)
    for call in code.calls("Thread"):
        kept = [each for each in call.keywords if each.arg != "daemon"]
        if len(kept) < len(call.keywords):
            change.swaps.append((call, ast.unparse(ast.Call(call.func, call.args, kept))))
    return change.as_step() if change.swaps else shut_down_rclpy(code)


def _entry(code: Code) -> Function | None:
    """The function of the file that the program begins with."""
    begun = [call for each in code.top if not isinstance(each, _DEFINES) for call in ast.walk(each)]
    called = [source.called_name(call) for call in begun if isinstance(call, ast.Call)]
    functions = {each.name: each for each in code.top if isinstance(each, Function)}
    return next((functions[name] for name in called if name in functions), None)


def end_with_zero(code: Code) -> str | None:
    """The step by which a program that has done all its work ends with 0."""
    change = Changes(code)
    for call in code.calls(*_EXITS):
        given = call.args[0] if call.args else None
        if given is None or (isinstance(given, ast.Constant) and not given.value):
            continue
        begun = [
            each for each in ast.walk(given) if isinstance(each, ast.Call) and code.named(source.called_name(each))
        ]
        tests = [each for each in code.ancestors(call) if isinstance(each, ast.If)]
        if (silent := _silent(code, tests)) is not None:
            return code.as_step(edits.insert_below(silent.end_lineno or 0, "return True", like=silent.body[0].lineno))
        if begun and isinstance(code.statement(call), ast.Expr):
            change.swaps.append((call, ast.unparse(begun[0])))
        else:
            change.swaps.append((given, "0"))
    return change.as_step() if change.swaps else None


def _silent(code: Code, tests: Sequence[ast.If]) -> Function | None:
    """The function whose result is asked for here, and which gives none at its end."""
    names = {each.id for test in tests for each in ast.walk(test.test) if isinstance(each, ast.Name)}
    for each in code.nodes:
        if isinstance(each, ast.Assign) and isinstance(each.value, ast.Call) and ast.unparse(each.targets[0]) in names:
            for function in code.named(source.called_name(each.value)):
                if not isinstance(function.body[-1], ast.Return):
                    return function
    return None


def remove_calls(code: Code, *names: str) -> str | None:
    """The step that takes out the statements that only call one of these functions."""
    calls = [code.statement(call) for call in code.calls(*names)]
    gone = [each for each in calls if isinstance(each, ast.Expr)]
    return code.as_step([edits.remove_statement(code.text, each) for each in gone])


def remove_input(code: Code) -> str | None:
    """The step by which a program takes numbers that are written in it, and asks nobody for them."""
    change = Changes(code)
    for call in code.calls("input"):
        if isinstance(code.statement(call), ast.Expr) and code.statement(call).value is call:  # type: ignore[attr-defined]
            change.more.append(edits.remove_statement(code.text, call))
        else:
            change.swaps.append((call, repr("8" if not change.swaps else "2")))
    return change.as_step() if change.swaps or change.more else None


def move_return(code: Code) -> tuple[ast.For, ast.Return, str] | None:
    """A `return` at the end of a loop, which ends it with its first turn, and the step that puts it below."""
    for loop in code.nodes:
        if isinstance(loop, ast.For) and len(loop.body) > 1 and isinstance(step := loop.body[-1], ast.Return):
            end = step.end_lineno or step.lineno
            below = edits.insert_below(loop.end_lineno or end, ast.unparse(step), like=loop.lineno)
            if (told := code.as_step(below, edits.remove_lines(code.text, step.lineno, end))) is not None:
                return loop, step, told
    return None


def shut_down_rclpy(code: Code) -> str | None:
    """The step that ends ROS, and with it a thread that spins, where the program is done."""
    rclpy, entry = code.imported("rclpy"), _entry(code)
    if entry is not None:
        return code.as_step(edits.append_to_function(entry, f"{rclpy}.shutdown()"))
    if not code.top:
        return None
    last = code.top[-1]
    return code.as_step(edits.insert_after(last, f"{rclpy}.shutdown()"))
