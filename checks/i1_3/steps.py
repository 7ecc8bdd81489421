"""I1.3: steps that make the client call all four services and exit with 0."""

from __future__ import annotations

import ast
import textwrap
from collections.abc import Iterator, Sequence

from checks.i1_3.code import Code
from checks.i1_3.facts import OPERATOR_SIGNS
from checks.i1_3.services import Changes
from tutor.judge import edits, source
from tutor.judge.rewriting.program import make_daemon
from tutor.judge.source import Function

_DEFINITIONS = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef
_EXITS = "exit", "_exit", "quit", "SystemExit"


def add_to_list(code: Code, missing: Sequence[str]) -> str | None:
    """Step: add the missing services to the list of those that are called."""
    for each in code.nodes:
        items = each.elts if isinstance(each, ast.Tuple | ast.List) else []
        names = {str(found.value).strip("/"): (found, item) for item in items for found in _first_text(item)}
        present = {f"/{name}" for name in names}
        if len(names) >= 2 and present <= set(OPERATOR_SIGNS) and not present & set(missing):
            text, item = list(names.values())[-1]
            model = str(text.value)
            last = ast.unparse(item)
            new = [last.replace(repr(model), repr(model.replace(model.strip("/"), name[1:]))) for name in missing]
            return code.as_step(edits.replace_node(code.text, item, ", ".join([last, *new])))
    return None


def _first_text(item: ast.expr) -> Iterator[ast.Constant]:
    """Yield the string that a list item is or begins with, if any."""
    if isinstance(item, ast.Tuple | ast.List) and item.elts:
        item = item.elts[0]
    if isinstance(item, ast.Constant) and isinstance(item.value, str):
        yield item


def join_thread(code: Code) -> str | None:
    """Step: make a spinning thread non-daemon, so that Python waits for it at exit; else shut down rclpy to end it."""
    change = Changes(code)
    for call in code.calls("Thread"):
        kept = [each for each in call.keywords if each.arg != "daemon"]
        if len(kept) < len(call.keywords):
            change.swaps.append((call, ast.unparse(ast.Call(call.func, call.args, kept))))
    return change.as_step() if change.swaps else shut_down_rclpy(code)


def make_thread_daemon(code: Code, function: str) -> str | None:
    """Step: make the thread that runs this function a daemon, so that Python does not wait for it at exit."""
    made = [
        call
        for call in code.calls("Thread")
        if function in [source.last_name(each.value) for each in call.keywords if each.arg == "target"]
    ]
    return code.as_step([make_daemon(code, call) for call in made])


def _find_entry_point(code: Code) -> Function | None:
    """Find the first function of the file that top-level code calls."""
    nodes = [node for each in code.top if not isinstance(each, _DEFINITIONS) for node in ast.walk(each)]
    called = [source.called_name(node) for node in nodes if isinstance(node, ast.Call)]
    functions = {each.name: each for each in code.top if isinstance(each, Function)}
    return next((functions[name] for name in called if name in functions), None)


def end_with_zero(code: Code) -> str | None:
    """Step: exit with 0 when all calls have been made."""
    change = Changes(code)
    for call in code.calls(*_EXITS):
        given = call.args[0] if call.args else None
        if given is None or (isinstance(given, ast.Constant) and not given.value):
            continue
        own_calls = [
            each
            for each in ast.walk(given)
            if isinstance(each, ast.Call) and code.functions_named(source.called_name(each))
        ]
        tests = [each for each in code.ancestors(call) if isinstance(each, ast.If)]
        if (function := _find_function_without_result(code, tests)) is not None:
            below = edits.insert_below(function.end_lineno or 0, "return True", like=function.body[0].lineno)
            return code.as_step(below)
        statement = code.statement(call)
        if own_calls and isinstance(statement, ast.Raise):
            change.more.append(edits.replace_statement(statement, ast.unparse(own_calls[0])))
        elif own_calls and isinstance(statement, ast.Expr):
            change.swaps.append((call, ast.unparse(own_calls[0])))
        else:
            change.swaps.append((given, "0"))
    return change.as_step() if change.swaps or change.more else None


def _find_function_without_result(code: Code, tests: Sequence[ast.If]) -> Function | None:
    """Find a function whose result these conditions test, though it does not end with a return."""
    names = {each.id for test in tests for each in ast.walk(test.test) if isinstance(each, ast.Name)}
    for each in code.nodes:
        if isinstance(each, ast.Assign) and isinstance(each.value, ast.Call) and ast.unparse(each.targets[0]) in names:
            for function in code.functions_named(source.called_name(each.value)):
                if not isinstance(function.body[-1], ast.Return):
                    return function
    return None


def remove_calls(code: Code, *names: str) -> str | None:
    """Step: remove the statements that only call one of these functions."""
    statements = [code.statement(call) for call in code.calls(*names)]
    removable = [each for each in statements if isinstance(each, ast.Expr)]
    return code.as_step([edits.remove_statement(code.text, each) for each in removable])


def remove_input(code: Code) -> str | None:
    """Step: replace keyboard input with fixed numbers."""
    change = Changes(code)
    for call in code.calls("input"):
        if isinstance(code.statement(call), ast.Expr) and code.statement(call).value is call:  # type: ignore[attr-defined]
            change.more.append(edits.remove_statement(code.text, call))
        else:
            change.swaps.append((call, repr("8" if not change.swaps else "2")))
    return change.as_step() if change.swaps or change.more else None


def remove_arguments(code: Code) -> str | None:
    """Step: replace the numbers of the command line by fixed ones, and remove the test that ends without them.

    None where the command line also says which service to call.
    """
    change, numbers = Changes(code), 0
    tests = [each for each in code.nodes if isinstance(each, ast.If) and "argv" in ast.unparse(each.test)]
    for test in tests:
        kept = test.orelse if any(map(_ends, test.body)) else test.body if any(map(_ends, test.orelse)) else [test]
        if kept:
            return None if kept == [test] else code.as_step(edits.replace_statement(test, _code_of(code, kept)))
        change.more.append(edits.remove_statement(code.text, test))
    for node in code.nodes:
        match node:
            case ast.Call(func=ast.Name(id="int" | "float"), args=[ast.Subscript(value=value)]) if (
                "argv" in ast.unparse(value)
            ):
                numbers += 1
                change.swaps.append((node, "12" if numbers % 2 else "4"))
    used = [each for each in code.nodes if isinstance(each, ast.Subscript) and "argv" in ast.unparse(each.value)]
    return change.as_step() if change.more and len(used) == numbers else None


def _ends(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Return | ast.Raise) or bool(source.calls_in(statement, *_EXITS))


def _code_of(code: Code, statements: Sequence[ast.stmt]) -> str:
    lines = code.text.splitlines()[statements[0].lineno - 1 : statements[-1].end_lineno]
    return textwrap.dedent("\n".join(lines))


def move_return(code: Code) -> tuple[ast.For, ast.Return, str] | None:
    """Find a `return` that ends a loop in its first iteration: the loop, the return, and the step to move it below."""
    for loop in code.nodes:
        if isinstance(loop, ast.For) and len(loop.body) > 1 and isinstance(last := loop.body[-1], ast.Return):
            end = last.end_lineno or last.lineno
            below = edits.insert_below(loop.end_lineno or end, ast.unparse(last), like=loop.lineno)
            if (step := code.as_step(below, edits.remove_lines(code.text, last.lineno, end))) is not None:
                return loop, last, step
    return None


def shorten_loop(code: Code, line: int) -> str | None:
    """Step: let a loop around this line that goes on while something is at most a number end one earlier."""
    for each in code.nodes:
        if isinstance(each, ast.While) and each.lineno <= line <= (each.end_lineno or 0):
            for test in ast.walk(each.test):
                if isinstance(test, ast.Compare) and len(test.ops) == 1 and isinstance(test.ops[0], ast.LtE):
                    shorter = ast.unparse(ast.Compare(test.left, [ast.Lt()], test.comparators))
                    return code.as_step(edits.replace_node(code.text, test, shorter))
    return None


def shut_down_rclpy(code: Code, joined_at: int = 0) -> str | None:
    """Step: shut down rclpy at the end of the program, which also ends a spinning thread.

    `joined_at`: the line that waits for that thread; then shut down above it, and not again later.
    """
    shutdown, entry = f"{code.local_name('rclpy')}.shutdown()", _find_entry_point(code)
    if joined_at and code.statement_at(joined_at) is not None:
        statements = [each for each in code.nodes if isinstance(each, ast.Expr) and each.lineno > joined_at]
        again = [each for each in statements if ast.unparse(each).endswith("shutdown()")]
        return code.as_step(
            edits.insert_above(joined_at, shutdown), [edits.remove_statement(code.text, each) for each in again]
        )
    if entry is not None:
        return code.as_step(edits.append_to_function(entry, shutdown))
    return code.as_step(edits.insert_after(code.top[-1], shutdown)) if code.top else None
