"""The next step for a process that does not end well on Ctrl+C, from the lines that the learner's file has."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from tutor.judge import source
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame

_IMPORT = "from rclpy.executors import ExternalShutdownException"
_BOTH = "except (KeyboardInterrupt, ExternalShutdownException):"
_GUARDS = {"KeyboardInterrupt", "BaseException"}


def catching(trace: Trace, own: Frame | None) -> str:
    """How KeyboardInterrupt and ExternalShutdownException, which both end a spin, are caught around the line `own`."""
    add = "" if _imported(trace) else f", with {_IMPORT} at the top"
    around = [each for each in _tries(trace) if own is not None and _covers(each.body, own.line)]
    for handler in (handler for each in around for handler in each.handlers):
        caught = ast.unparse(handler.type) if handler.type else ""
        if "KeyboardInterrupt" in caught or "ExternalShutdownException" in caught:
            return f"line {handler.lineno} becomes: {_BOTH}{add}"
    if around:
        first = around[0].handlers[0] if around[0].handlers else None
        where = (
            f"above line {first.lineno}"
            if first
            else f"above the finally: of the try block that begins in line {around[0].lineno}"
        )
        return f"write {where}, with the same indentation: {_BOTH} pass{add}{_and_shut_down(trace)}"
    if own is None:
        return (
            "let the thread run a function of your own: def spin(): try: executor.spin() "
            f"except ExternalShutdownException: pass, and Thread(target=spin){add}"
        )
    end = "" if source.mentions(trace, "try_shutdown") else " / finally: rclpy.try_shutdown()"
    return f"in place of line {own.line}: try: {own.code} / {_BOTH} pass{end}{add}{_and_shut_down(trace)}"


def shutting_down(trace: Trace) -> str:
    """How a second shutdown is avoided."""
    lines = [call.lineno for call in source.calls(trace, "shutdown") if ast.unparse(call.func) == "rclpy.shutdown"]
    return f"write rclpy.try_shutdown() in place of rclpy.shutdown(){_in(lines)}"


def _and_shut_down(trace: Trace) -> str:
    plain = any(ast.unparse(call.func) == "rclpy.shutdown" for call in source.calls(trace, "shutdown"))
    return f"; and {shutting_down(trace)}" if plain else ""


def letting_go(trace: Trace) -> str:
    """What keeps Ctrl+C from ending the program, as far as the source tells."""
    steps = []
    for call in source.calls(trace, "signal"):
        if "SIGINT" in ast.unparse(call):
            steps.append(f"delete line {call.lineno}, {ast.unparse(call)}: rclpy handles Ctrl+C by itself")
    for loop in (node for node in source.nodes(trace) if isinstance(node, ast.While)):
        swallowed = [each for each in _swallowing(loop) if not _leaves(each.body)]
        if swallowed:
            steps.append(f"write break in place of line {swallowed[0].body[0].lineno}, so that Ctrl+C leaves the loop")
        elif isinstance(loop.test, ast.Constant):
            steps.append(f"line {loop.lineno} becomes: while rclpy.ok():")
    for call in source.calls(trace, "Thread"):
        if not any(each.arg == "daemon" for each in call.keywords):
            steps.append(
                f"give the thread of line {call.lineno} daemon=True, so that it does not keep the program alive"
            )
    steps = list(dict.fromkeys(steps))[:3]
    return "\n".join(steps) or (
        "let KeyboardInterrupt end the program: no bare `except:` around spin, no loop without rclpy.ok()"
    )


def returning(trace: Trace) -> str:
    """How the program ends with exit code 0."""
    lines = [call.lineno for call in source.calls(trace, "exit", "_exit", "abort", "kill")]
    if lines:
        return f"delete what ends the program{_in(lines)}, and let main() return: then the exit code is 0"
    return "return normally from main() after Ctrl+C; call no sys.exit() with another code"


def raises(own: Frame | None) -> bool:
    """Whether the line raises an exception by itself."""
    return own is not None and own.code.startswith("raise")


def leaving_out(own: Frame | None) -> str:
    """What to do about a line that raises, or that needs ROS when it is shut down already."""
    if own is not None and raises(own):
        return f"write return in place of line {own.line}, {own.code}: Ctrl+C is a normal end, and no error"
    if own is None or re.search(r"\bspin\w*\(", own.code):
        return "after Ctrl+C the node can neither publish nor log over ROS: stop before that, or catch the exception"
    return (
        f"leave out line {own.line}, {own.code}: after Ctrl+C the node can neither publish nor log over ROS; print() "
        "still works"
    )


def _tries(trace: Trace) -> list[ast.Try]:
    """The try blocks, innermost first."""
    found = [node for node in source.nodes(trace) if isinstance(node, ast.Try)]
    return sorted(found, key=lambda each: -each.lineno)


def _covers(body: Sequence[ast.stmt], line: int) -> bool:
    return any(each.lineno <= line <= (each.end_lineno or each.lineno) for each in body)


def _swallowing(loop: ast.While) -> Iterator[ast.ExceptHandler]:
    """The handlers in a loop that catch KeyboardInterrupt."""
    for node in ast.walk(loop):
        if isinstance(node, ast.ExceptHandler):
            caught = ast.unparse(node.type) if node.type else ""
            if not caught or any(name in caught for name in _GUARDS):
                yield node


def _leaves(body: Sequence[ast.stmt]) -> bool:
    return any(isinstance(each, ast.Break | ast.Return | ast.Raise) for stmt in body for each in ast.walk(stmt))


def _imported(trace: Trace) -> bool:
    return any(
        isinstance(node, ast.ImportFrom) and any(each.name == "ExternalShutdownException" for each in node.names)
        for node in source.nodes(trace)
    )


def _in(lines: Sequence[int]) -> str:
    if not lines:
        return ""
    return f" in line {lines[0]}" if len(lines) == 1 else f" in lines {', '.join(map(str, lines))}"
