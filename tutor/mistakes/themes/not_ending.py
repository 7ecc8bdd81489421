"""What keeps a program running after Ctrl+C."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.ending import SPIN_ENDINGS
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Ending
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.themes.spinning import SPINS
from tutor.source import Function, NodeFile, called_name, calls_in, is_endless, last_name

_ENDS = (ast.Raise, ast.Return, ast.Break)
_EXITS = ("exit", "_exit", "quit", "abort", "kill")
_TALK = ("print", "write", "flush", "get_logger", "debug", "info", "warn", "warning", "error", "fatal")


def limit_s(case: Case) -> float:
    """How long the program may take to end on Ctrl+C."""
    ending: Ending | None = case.about("ending")
    return ending.limit_s if ending is not None else 5.0


@mistake(
    "sigint-ignored",
    name="SIGINT ignored",
    explains=[Symptom.DOES_NOT_END],
    says="{line} {what}: {code}",
    do="Leave the signal to Python and rclpy, or let its handler end the program.",
)
def sigint_ignored(case: Case) -> Iterator[Found]:
    """The program takes Ctrl+C for itself, and does not end.

    Ctrl+C sends the signal SIGINT. Python makes it a KeyboardInterrupt, and rclpy shuts down. A handler of one's own
    takes the place of both: if it does not end the program, nothing does.

    Bad:

        signal.signal(signal.SIGINT, lambda *args: print('please wait'))

    Good:

        signal.signal(signal.SIGINT, lambda *args: sys.exit(0))

    See it: Ctrl+C in a terminal; then end it with Ctrl+Z and kill.
    """
    for file in case.files:
        for call in file.calls("signal"):
            if len(call.args) != 2 or re.search(r"\bSIG(?!INT\b)[A-Z0-9]+$", ast.unparse(call.args[0])):
                continue
            handler = call.args[1]
            if last_name(handler) == "SIG_IGN":
                yield found(file, call, what="switches SIGINT, the signal of Ctrl+C, off")
                continue
            function = handler if isinstance(handler, ast.Lambda) else file.function(handler)
            if function is not None and not _may_end(case, file, function):
                yield found(file, call, what="handles Ctrl+C itself, and the handler does not end the program")


def _may_end(case: Case, file: NodeFile, handler: Function | ast.Lambda) -> bool:
    """Whether a handler may end the program: by anything but output and its own variables."""
    asked = {
        last_name(part) for node in case.program.nodes() if isinstance(node, ast.While) for part in ast.walk(node.test)
    }
    reached = file.reachable_from(handler) if isinstance(handler, Function) else [handler]
    for node in (inner for function in reached for inner in ast.walk(function)):
        match node:
            case ast.Raise():
                return True
            case ast.Call() if called_name(node) not in _TALK and file.function(node.func) not in reached:
                return True
            case ast.Name(ctx=ast.Store()) | ast.Attribute(ctx=ast.Store()) if last_name(node) in asked:
                return True
    return False


@mistake(
    "interrupt-swallowed",
    explains=[Symptom.DOES_NOT_END],
    says="{line} catches what Ctrl+C raises, and the endless loop around it goes on: {code}",
    do="Let Ctrl+C end the loop: leave it there, or catch only the exceptions that you expect.",
)
def interrupt_swallowed(case: Case) -> Iterator[Found]:
    """A loop catches the exception of Ctrl+C, and goes on.

    Python turns Ctrl+C into an exception, KeyboardInterrupt. An except without a type catches it like any other, and in
    a loop without end the program then simply takes the next turn.

    Bad:

        while True:
            try:
                rclpy.spin_once(node)
            except:
                pass

    Good:

        while rclpy.ok():
            rclpy.spin_once(node)

    See it: Ctrl+C in a terminal; then end it with Ctrl+Z and kill.
    """
    for file in case.files:
        for node in file.nodes:
            if isinstance(node, ast.Try):
                loop = next((ancestor for ancestor in file.ancestors(node) if isinstance(ancestor, ast.While)), None)
                goes_on = (
                    loop is not None and is_endless(loop) and file.function_around(loop) is file.function_around(node)
                )
                yield from (found(file, handler) for handler in node.handlers if goes_on and _swallows(node, handler))


def _swallows(around: ast.Try, handler: ast.ExceptHandler) -> bool:
    """Whether a handler catches whatever Ctrl+C raises in its block, and goes on."""
    caught = ast.unparse(handler.type) if handler.type is not None else "BaseException"
    spins = any(calls_in(statement, *SPINS) for statement in around.body)
    # A spin after Ctrl+C raises ExternalShutdownException, which KeyboardInterrupt does not catch.
    wanted = SPIN_ENDINGS if spins else SPIN_ENDINGS[:1]
    catches = "BaseException" in caught or all(name in caught for name in wanted)
    return catches and not any(
        isinstance(node, _ENDS) or (isinstance(node, ast.Call) and called_name(node) in _EXITS)
        for node in ast.walk(handler)
    )


@mistake(
    "too-slow-to-end",
    explains=[Symptom.DOES_NOT_END],
    says="{line} waits for {seconds:g} s after Ctrl+C, and the program has {limit:g} s to end: {code}",
    do="Do without that wait: what is left to do after Ctrl+C should take no time.",
)
def too_slow_to_end(case: Case) -> Iterator[Found]:
    """The program waits after Ctrl+C.

    Who presses Ctrl+C wants the program to end. A launch file gives its nodes five seconds, and then kills them.

    Bad:

        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            time.sleep(20)

    Good:

        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            print('closed')

    See it: Ctrl+C in a terminal, and wait.
    """
    limit = limit_s(case)
    for file in case.files:
        for nap in file.calls("sleep"):
            seconds = nap.args[0].value if nap.args and isinstance(nap.args[0], ast.Constant) else None
            if isinstance(seconds, int | float) and seconds >= limit and _comes_after_ctrl_c(file, nap):
                yield found(file, nap, seconds=seconds, limit=limit)


def _comes_after_ctrl_c(file: NodeFile, call: ast.Call) -> bool:
    """Whether a call is in a handler of what Ctrl+C raises, or behind a spin that only Ctrl+C ends."""
    around = [node for node in file.ancestors(call) if isinstance(node, ast.ExceptHandler)]
    if around:
        return any(node.type is None or any(name in ast.unparse(node.type) for name in SPIN_ENDINGS) for node in around)
    function = file.function_around(call)
    spins = [spin for spin in calls_in(function, "spin") if file.function_around(spin) is function]
    return any(spin.lineno < call.lineno for spin in spins)
