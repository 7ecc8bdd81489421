"""Threads that keep a program running after Ctrl+C."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.themes.not_ending import limit_s
from tutor.mistakes.themes.spinning import SPINS
from tutor.source import Function, NodeFile, called_name, calls_in, is_endless, last_name, values_of


@mistake(
    "thread-goes-on",
    explains=[Symptom.DOES_NOT_END],
    says="{line} {what} in a thread that is no daemon, and Python waits for it when main() has ended: {code}",
    do="Make the thread a daemon, or let it end when rclpy is no longer up.",
)
def thread_goes_on(case: Case) -> Iterator[Found]:
    """A thread keeps the program alive.

    Python ends a program when all its threads have ended, but for daemons, which just stop. A thread in a loop without
    end, started from a class or from a pool, goes on after Ctrl+C, and the program with it.

    Bad:

        def watch():
            while True:
                time.sleep(1.0)

        Thread(target=watch).start()

    Good:

        def watch():
            while True:
                time.sleep(1.0)

        Thread(target=watch, daemon=True).start()

    See it: Ctrl+C in a terminal; `py-spy dump --pid PID` shows what still runs.
    """
    for file in case.files:
        for call in file.calls("Thread", "submit"):
            named = [keyword.value for keyword in call.keywords if keyword.arg == "target"]
            target = next(iter([*named, *(call.args[:1] if called_name(call) == "submit" else [])]), None)
            if _is_daemon(file, call, file.assigned_to(call)):
                continue
            if (seconds := _nap(call, target)) >= limit_s(case):
                yield found(file, call, what=f"sleeps for {seconds:g} s")
            yield from _endless_loops(file, file.function(target))
        for owner in file.nodes:
            if isinstance(owner, ast.ClassDef) and any(last_name(base) == "Thread" for base in owner.bases):
                made: list[ast.Call | None] = [
                    call for call in calls_in(owner, "__init__") if "super" in ast.unparse(call.func)
                ]
                if not any(_is_daemon(file, call, "self") for call in made or [None]):
                    methods = [statement for statement in owner.body if isinstance(statement, ast.FunctionDef)]
                    run = next((method for method in methods if method.name == "run"), None)
                    yield from _endless_loops(file, run)


def _is_daemon(file: NodeFile, made: ast.Call | None, name: str) -> bool:
    """Whether a thread is made a daemon, by this call, or as an attribute of what it is assigned to."""
    given = [keyword.value for keyword in made.keywords if keyword.arg == "daemon"] if made is not None else []
    given += values_of(f"{name}.daemon", file.tree)
    return any(ast.unparse(value) != "False" for value in given)


def _nap(call: ast.Call, target: ast.expr | None) -> float:
    """For how many seconds a thread sleeps whose target is sleep itself."""
    given = [*call.args[1:], *(keyword.value for keyword in call.keywords if keyword.arg == "args")]
    numbers = [node.value for value in given for node in ast.walk(value) if isinstance(node, ast.Constant)]
    return next(
        (float(number) for number in numbers if last_name(target) == "sleep" and isinstance(number, int | float)), 0.0
    )


def _endless_loops(file: NodeFile, target: Function | None) -> Iterator[Found]:
    """The loops in a thread's function, and in what it calls, that nothing ends."""
    for function in file.reachable_from(target) if target is not None else ():
        for loop in ast.walk(function):
            # What needs a node raises an exception after Ctrl+C, and that ends the thread.
            if isinstance(loop, ast.While) and is_endless(loop) and not calls_in(loop, *SPINS, "publish"):
                yield found(file, loop, what="loops without end")


@mistake(
    "waits-for-the-spin-before-the-shutdown",
    explains=[Symptom.DOES_NOT_END],
    says="{line} waits for the spin to end, and what ends it, the shutdown in line {later}, comes only after: {code}",
    do="Shut rclpy down first, and then wait.",
)
def waits_for_spin(case: Case) -> Iterator[Found]:
    """A program waits for a spin that nobody ends.

    A spin in a thread ends when rclpy is shut down. Where the program handles Ctrl+C itself, as with asyncio, it has
    to shut rclpy down before it waits for that thread.

    Bad:

        signal.signal(signal.SIGINT, lambda *_: stop.set())
        spinning = Thread(target=rclpy.spin, args=(node,))
        spinning.start()
        stop.wait()
        spinning.join()
        rclpy.try_shutdown()

    Good:

        signal.signal(signal.SIGINT, lambda *_: stop.set())
        spinning = Thread(target=rclpy.spin, args=(node,))
        spinning.start()
        stop.wait()
        rclpy.try_shutdown()
        spinning.join()

    See it: Ctrl+C in a terminal: the program hangs.
    """
    if not case.program.mentions("signal", "asyncio", "add_signal_handler", "SignalHandlerOptions"):
        return  # then rclpy's own handler ends the spin
    for file in case.files:
        for later in map(file.statement, file.calls("shutdown", "try_shutdown")):
            for earlier in file.block_of(later):
                if earlier.lineno < later.lineno and _waits_for_spin(file, earlier):
                    yield found(file, earlier, later=later.lineno)


def _waits_for_spin(file: NodeFile, statement: ast.stmt) -> bool:
    match statement:
        case ast.Expr(value=ast.Await(value=ast.Name(id=name))):
            pass
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="join" | "result"))):
            pass
        case _:
            return False
    calls = [value for value in values_of(name, file.tree) if isinstance(value, ast.Call)]
    passed = [given for call in calls for given in (*call.args, *(keyword.value for keyword in call.keywords))]
    return any(isinstance(given, ast.Attribute) and given.attr in SPINS for given in passed)
