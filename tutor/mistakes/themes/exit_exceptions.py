"""What a program raises when Ctrl+C ends it."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge import tracebacks
from tutor.judge.ending import SPIN_ENDINGS
from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame, Traceback
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.exceptions import found_in
from tutor.mistakes.raised_exceptions import RaisedException
from tutor.mistakes.themes.spinning import SPINS
from tutor.source import NodeFile, calls_in

_SHUT_DOWN_TWICE = ("rcl_shutdown already called", "Context must be initialized before it can be shutdown")
_INVALID_CONTEXT = ("context is invalid", "context is not valid", "context argument is null")


def _raised(case: Case) -> RaisedException | None:
    """The last exception that the process has raised after Ctrl+C, as the criterion chose it; None without one."""
    last: Traceback | None = case.about("raised")
    return next((seen for seen in case.exceptions if seen.traceback is last), None)


def _example(kind: str, message: str = "", *frames: Frame) -> Traceback:
    return Traceback(kind, message, frames)


@mistake(
    "shutdown-after-ctrl-c",
    name="shutdown() after Ctrl+C",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.PROCESS,
    says="Ctrl+C has already shut rclpy down, so {what} raises {exception}",
    do="Call try_shutdown in its place, which does nothing if rclpy is down already.",
    remark="after Ctrl+C rclpy is shut down already, and this raises RCLError; try_shutdown does not.",
    example=in_run(Symptom.ENDS_BADLY, raised=_example("rclpy._rclpy_pybind11.RCLError", _SHUT_DOWN_TWICE[0])),
)
def shut_down_twice(case: Case) -> Iterator[Found]:
    """After Ctrl+C, rclpy is shut down a second time.

    On Ctrl+C, rclpy's own signal handler shuts the context down, and spin() ends with an exception. A bare
    rclpy.shutdown() after that finds nothing to shut down, and raises an RCLError.

    Bad:

        try:
            rclpy.spin(node)
        except KeyboardInterrupt:
            pass
        rclpy.shutdown()

    Good:

        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        rclpy.try_shutdown()

    See it: Ctrl+C in a terminal.

    Lesson: i2.3, on ending cleanly.
    """
    if case.passed:
        yield from (found(case.file, call) for call in _bare_shutdowns(case.file))
    seen = _raised(case)
    if seen is not None and any(words in seen.traceback.message for words in _SHUT_DOWN_TWICE):
        own = seen.line
        yield found_in(
            seen,
            what=f"{own.code} ({own.name}, line {own.line})" if own is not None else "a second shutdown()",
            exception=seen.name,
        )


def _bare_shutdowns(file: NodeFile) -> Iterator[ast.Call]:
    """The calls of rclpy.shutdown() that follow a spin which Ctrl+C ends, with nothing that asks or catches."""
    if any(isinstance(node, ast.Name) and node.id == "SignalHandlerOptions" for node in file.nodes):
        return  # then Ctrl+C does not shut rclpy down
    for call in file.calls("shutdown"):
        if ast.unparse(call) != "rclpy.shutdown()" or _is_guarded(file, call):
            continue
        function = file.function_around(call)
        tries = [node for node in file.nodes if isinstance(node, ast.Try) and file.function_around(node) is function]
        if any(_is_reached(block, call) for block in tries if calls_in(ast.Module(block.body, []), *SPINS)):
            yield call


def _is_guarded(file: NodeFile, call: ast.Call) -> bool:
    """Whether a shutdown is done only if rclpy is up, or what it raises is caught."""
    for node in file.ancestors(call):
        if isinstance(node, ast.If) and calls_in(node.test, "ok"):
            return True
        if isinstance(node, ast.Try) and node.handlers and any(call in ast.walk(statement) for statement in node.body):
            return True
        if isinstance(node, ast.With) and any(calls_in(item.context_expr, "suppress") for item in node.items):
            return True
    return False


def _is_reached(spinning: ast.Try, call: ast.Call) -> bool:
    """Whether a call is reached after Ctrl+C has ended the spin in this block."""
    if any(call in ast.walk(statement) for statement in spinning.finalbody):
        return True
    catching = [
        handler for handler in spinning.handlers if handler.type is None or SPIN_ENDINGS[0] in ast.unparse(handler.type)
    ]
    if any(call in ast.walk(handler) for handler in catching):
        return True
    leaves = any(isinstance(node, ast.Raise | ast.Return) for handler in catching for node in ast.walk(handler))
    return bool(catching) and not leaves and call.lineno > (spinning.end_lineno or 0)


@mistake(
    "threads-waited-for-at-exit",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.PROCESS,
    says="main() has ended, but Python still waits for its threads, where nothing catches the KeyboardInterrupt",
    do="Join the threads in main(), and catch KeyboardInterrupt there.",
    example=in_run(
        Symptom.ENDS_BADLY,
        raised=_example("KeyboardInterrupt", "", Frame("/lib/threading.py", 1, "_shutdown", "")),
    ),
)
def threads_at_exit(case: Case) -> Iterator[Found]:
    """Python waits for threads when main() is over.

    A program ends when all its threads have ended. Python waits for them after the last line, where nothing catches
    what Ctrl+C raises.

    Bad:

        Thread(target=executor.spin).start()

    Good:

        thread = Thread(target=executor.spin)
        thread.start()
        try:
            thread.join()
        except KeyboardInterrupt:
            rclpy.try_shutdown()

    See it: Ctrl+C in a terminal: "Exception ignored in: <module 'threading'".
    """
    seen = _raised(case)
    if seen is not None and any(
        frame.function == "_shutdown" and frame.path.endswith("/threading.py") for frame in seen.traceback.frames
    ):
        yield Found()


@mistake(
    "traceback-on-exit",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.PROCESS,
    says="{raised} reaches the end of the {what}, and nothing catches it",
    do="{do}",
    example=in_run(Symptom.ENDS_BADLY, raised=_example("KeyboardInterrupt")),
)
def uncaught_interrupt(case: Case) -> Iterator[Found]:
    """Ctrl+C ends the program with a traceback.

    On Ctrl+C, spin() ends with KeyboardInterrupt or, if rclpy's signal handler was faster or a thread spins, with
    ExternalShutdownException. If nothing catches it, Python prints a traceback, and the exit code is not 0.

    Bad:

        rclpy.spin(node)

    Good:

        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass

    See it: Ctrl+C in a terminal, then `echo $?`.

    Lesson: i2.3, on ending cleanly.
    """
    seen = _raised(case)
    if seen is None or not seen.name.endswith(SPIN_ENDINGS):
        return
    frames = [frame for frame in seen.traceback.frames if tracebacks.is_in_folder(frame.path, seen.folder)]
    # What main() was doing; the innermost line may be in a callback, where nothing is to be caught.
    at = next((frame for frame in frames if frame.function != "<module>"), next(iter(frames), None))
    if any(frame.path.endswith("/threading.py") for frame in seen.traceback.frames):
        do = "Give the thread a function of yours that spins, and catches ExternalShutdownException."
        yield found_in(seen, what="thread", do=do)
    else:
        there = "the spin" if at is None or "spin" in at.code else f"line {at.line}"
        do = f"Catch around {there} what Ctrl+C raises: KeyboardInterrupt, and from a spin ExternalShutdownException."
        yield found_in(seen, what="program", do=do)


@mistake(
    "used-after-shutdown",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.PROCESS,
    says="{raised}: after Ctrl+C a node can neither spin nor publish",
    do="Stop what uses the node before the shutdown, or do without ROS there: print() still works.",
    example=in_run(Symptom.ENDS_BADLY, raised=_example("rclpy._rclpy_pybind11.RCLError", _INVALID_CONTEXT[1])),
)
def used_after_shutdown(case: Case) -> Iterator[Found]:
    """A node is used after the shutdown.

    Ctrl+C shuts the context down first. From then on, publish() and whatever else needs DDS raises an exception, and a
    log message reaches only the terminal.

    Bad:

        finally:
            node.lamp.publish(Bool(data=False))

    Good:

        finally:
            print('lamp left as it is')

    See it: Ctrl+C in a terminal.
    """
    seen = _raised(case)
    if seen is not None and any(words in seen.traceback.message for words in _INVALID_CONTEXT):
        yield found_in(seen)


@mistake(
    "exception-on-exit",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.SYMPTOM,
    says="after Ctrl+C, {raised}",
    do="{do}",
    example=in_run(Symptom.ENDS_BADLY, raised=_example("ValueError", "ding")),
)
def exception_on_exit(case: Case) -> Iterator[Found]:
    """Something raises an exception while the program ends.

    After Ctrl+C, a program tidies up. An exception there, even one raised on purpose, makes a normal end look like a
    crash, with a traceback and exit code 1.

    Bad:

        except KeyboardInterrupt:
            raise RuntimeError('stopped')

    Good:

        except KeyboardInterrupt:
            print('stopped')

    See it: Ctrl+C in a terminal, then `echo $?`.
    """
    for seen in case.exceptions[:1] if case.about("raised") is not None else ():
        if seen.line is None:
            do = "Find the line of yours that leads to it in the last lines of the output."
        elif seen.line.code.startswith("raise"):
            do = "Let it end there without an exception: Ctrl+C is a normal end, and no error."
        else:
            do = f"Change line {seen.line.line} of {seen.line.name}, where Python could not go on."
        yield found_in(seen, do=do)
