"""The next step for a process that does not exit cleanly on Ctrl+C, as edits of the learner's own file."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Sequence
from itertools import pairwise

from tutor.judge.edits import (
    Edit,
    insert_above,
    insert_after,
    remove_statement,
    replace_lines,
    replace_node,
    replace_pattern,
    replace_statement,
)
from tutor.judge.rewriting.callbacks import outermost
from tutor.judge.rewriting.node import NodeFile, find_in_files, node_files
from tutor.judge.rewriting.program import clean_ending, code_of, first_sound_step, guard_spin, make_daemons
from tutor.judge.rewriting.program_scope import SPINS
from tutor.judge.source import calls_in, mentions, values_of
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame

SPIN_ENDINGS = ("KeyboardInterrupt", "ExternalShutdownException")
"""The exceptions that rclpy ends a spin with on Ctrl+C."""


def catch_interrupt(trace: Trace, frames: Sequence[Frame] = ()) -> str:
    """How to catch the exceptions that end a spin, and shut rclpy down only once.

    `frames`: those of the KeyboardInterrupt, outermost first, if it interrupted something else.
    """
    return (
        find_in_files(trace, lambda file: file.step(_with_interrupt_caught(file)))
        or first_sound_step(trace, lambda file: _with_main_guarded(file, frames))
        or first_sound_step(trace, clean_ending)
        or (
            "write around spin(): try, and except (KeyboardInterrupt, ExternalShutdownException): pass, with from "
            "rclpy.executors import ExternalShutdownException at the top; and rclpy.try_shutdown() in place of "
            "rclpy.shutdown()"
        )
    )


def allow_interrupt(trace: Trace) -> str:
    """How to let Ctrl+C end the program."""
    # A program that catches Ctrl+C may wait for a thread that another file of it makes.
    catches = mentions(trace, "KeyboardInterrupt")
    elsewhere = [each for each in node_files(trace) if catches and each.file not in ("", trace.file)]
    return (
        next(filter(None, (each.step(make_daemons(each)) for each in elsewhere)), None)
        or find_in_files(trace, lambda file: file.step(_with_shutdown_before_wait(file)))
        or first_sound_step(trace, clean_ending)
        or first_sound_step(trace, make_daemons)
        or "let KeyboardInterrupt end the program: no bare `except:` around spin, no loop without rclpy.ok()"
    )


def _with_shutdown_before_wait(file: NodeFile) -> list[Edit]:
    """Edits that end a spin before the program waits for what spins: a thread, a future or a task of asyncio."""
    for later in map(file.statement, file.calls("shutdown", "try_shutdown")):
        block = file.block_of(later)
        wait = next((each for each in block if each.lineno < later.lineno and _waits_for_spin(file, each)), None)
        if isinstance(later, ast.Expr) and wait is not None:
            return [insert_above(wait.lineno, code_of(file, later)), remove_statement(file.text, later)]
    return []


def _waits_for_spin(file: NodeFile, statement: ast.stmt) -> bool:
    match statement:
        case ast.Expr(value=ast.Await(value=ast.Name(id=name))):
            pass
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="join" | "result"))):
            pass
        case _:
            return False
    calls = [each for each in values_of(name, file.tree) if isinstance(each, ast.Call)]
    passed = [given for call in calls for given in (*call.args, *(each.value for each in call.keywords))]
    return any(isinstance(each, ast.Attribute) and each.attr in SPINS for each in passed)


def exit_with_zero(trace: Trace) -> str:
    """How to end the program with exit code 0."""
    return (
        find_in_files(trace, _without_status_in_handler, _without_status)
        or first_sound_step(trace, clean_ending)
        or "return normally from main() after Ctrl+C; call no sys.exit() with another code, and end what uses the "
        "node, such as threads, before you destroy it"
    )


def _without_status(file: NodeFile) -> str | None:
    """The step that no longer exits with what a function returns, such as True, which is exit code 1."""
    for call in file.calls("exit", "SystemExit"):
        inner = call.args[0] if len(call.args) == 1 else None
        function = file.function(inner.func) if isinstance(inner, ast.Call) else None
        statement = file.statement(call)
        if inner is None or function is None or not isinstance(statement, ast.Expr | ast.Raise):
            continue
        if any(isinstance(each, ast.Return) and each.value is not None for each in ast.walk(function)):
            return file.step([replace_statement(statement, ast.unparse(inner))])
    return None


def _without_status_in_handler(file: NodeFile) -> str | None:
    """The step that exits with 0 in a signal handler, where the number of the signal is at hand."""
    for registered in file.calls("signal"):
        function = file.function(registered.args[1]) if len(registered.args) == 2 else None
        for call in calls_in(function, "exit", "_exit", "SystemExit"):
            if len(call.args) == 1 and ast.unparse(call.args[0]) not in ("0", "None"):
                return file.step([replace_node(file.text, call.args[0], "0")])
    return None


def wait_for_threads(trace: Trace) -> str:
    """How to wait for threads that are still running when main() has ended."""
    return find_in_files(trace, lambda file: file.step(_with_threads_joined(file))) or (
        "wait for each thread at the end of main(): try: thread.join(), except KeyboardInterrupt: pass"
    )


def is_raise(own: Frame | None) -> bool:
    """Whether the learner's line is itself a `raise` statement."""
    return own is not None and own.code.startswith("raise")


def remove_line(trace: Trace, own: Frame | None) -> str:
    """What to do about a line that raises, or that needs ROS after it has been shut down."""
    if own is not None and is_raise(own):
        instead = first_sound_step(
            trace, lambda file: [replace_lines(own.line, "return")] if own.name == trace.file else []
        )
        return instead or f"write return in place of line {own.line}, {own.code}: Ctrl+C is a normal end, and no error"
    return (
        first_sound_step(trace, clean_ending)
        or _without_statement(trace, own)
        or (
            "after Ctrl+C the node can neither publish nor log over ROS: stop before that, or catch the exception; "
            "print() still works"
        )
    )


def _without_statement(trace: Trace, own: Frame | None) -> str | None:
    """The step that removes the statement on this line, if it is nothing but a call."""

    def edits(file: NodeFile) -> list[Edit]:
        statement = file.statement_at(own.line) if own is not None and own.name == trace.file else None
        return [remove_statement(file.text, statement)] if isinstance(statement, ast.Expr) else []

    return first_sound_step(trace, edits)


def _with_interrupt_caught(file: NodeFile) -> list[Edit]:
    """Edits that catch both exceptions around each spin, and replace shutdown() by try_shutdown()."""
    found = replace_pattern(file.text, r"\brclpy\.shutdown\b", "rclpy.try_shutdown")
    spins = [each for each in file.calls(*SPINS) if ast.unparse(each.func) != "self.spin"]
    tries = [each for each in ast.walk(file.tree) if isinstance(each, ast.Try)]
    for call in spins:
        around = [each for each in tries if any(call in ast.walk(one) for one in each.body)]
        handlers = [handler for each in around for handler in each.handlers]
        if not around:
            found += guard_spin(file, call)
        for handler in handlers:
            caught = ast.unparse(handler.type) if handler.type is not None else ""
            if any(name in caught for name in SPIN_ENDINGS) and not all(name in caught for name in SPIN_ENDINGS):
                name, imported = file.import_name("ExternalShutdownException", "rclpy.executors")
                line = file.text.splitlines()[handler.lineno - 1].strip()
                both = f"except (KeyboardInterrupt, {name})"
                found += [
                    *imported,
                    replace_lines(handler.lineno, re.sub(r"except\b.*?(?= as |:)", both, line, count=1)),
                ]
    return list(dict.fromkeys([*found, *_guard_threads(file)]))


def _with_main_guarded(file: NodeFile, frames: Sequence[Frame]) -> list[Edit]:
    """Catch KeyboardInterrupt around what main() does when Ctrl+C is pressed."""
    calls = [each for each in frames if each.name == (file.file or each.name)]
    inner = next((after for before, after in pairwise(calls) if before.function == "<module>"), None)
    statement = (outermost(file, inner.line) or file.statement_at(inner.line)) if inner is not None else None
    if statement is None or isinstance(statement, ast.Return):
        return []
    return [replace_statement(statement, _with_interrupts_caught(code_of(file, statement)))]


def _with_interrupts_caught(code: str) -> str:
    return f"try:\n{textwrap.indent(code, '    ')}\nexcept KeyboardInterrupt:\n    pass"


def _guard_threads(file: NodeFile) -> list[Edit]:
    """Catch the exception that ends a spin which is the target of a thread."""
    found = []
    for call in file.calls("Thread"):
        target = next((each.value for each in call.keywords if each.arg == "target"), None)
        if isinstance(target, ast.Attribute) and target.attr in SPINS and ast.unparse(target) != "self.spin":
            name, imported = file.import_name("ExternalShutdownException", "rclpy.executors")
            code = (
                f"def spin_until_shutdown(*arguments, spin={ast.unparse(target)}):\n"
                f"    try:\n        spin(*arguments)\n    except {name}:\n        pass\n"
            )
            above = insert_above(file.statement(call).lineno, code)
            found += [*imported, above, replace_node(file.text, target, "spin_until_shutdown")]
    return found


def _with_threads_joined(file: NodeFile) -> list[Edit]:
    """Wait for the threads below the statement that starts the last of them, and catch KeyboardInterrupt there."""
    joins: list[str] = []
    last: ast.stmt | None = None
    for call in file.calls("start"):
        if not isinstance(call.func, ast.Attribute) or "self" in ast.unparse(call.func):
            continue
        thread, statement = ast.unparse(call.func.value), file.statement(call)
        loop = next(file.ancestors(statement), None)
        if isinstance(loop, ast.For) and ast.unparse(loop.target) == thread:
            joins.append(f"for {thread} in {ast.unparse(loop.iter)}:\n    {thread}.join()")
            last = loop
        elif isinstance(call.func.value, ast.Name):
            joins.append(f"{thread}.join()")
            last = statement
    if last is None:
        return []
    code = "\n".join(joins)
    tries = [each for each in file.ancestors(last) if isinstance(each, ast.Try) and last in each.body]
    caught = [ast.unparse(handler.type) for each in tries for handler in each.handlers if handler.type is not None]
    if not any("KeyboardInterrupt" in each for each in caught):
        code = _with_interrupts_caught(code)
    return [insert_after(last, code)]
