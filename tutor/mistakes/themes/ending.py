"""What keeps a program from ending cleanly on Ctrl+C."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Traceback
from tutor.mistakes.entry import Case, Evidence, Found, found, found_at, mistake
from tutor.mistakes.examples import in_run

SPIN_ENDINGS = ("KeyboardInterrupt", "ExternalShutdownException")
"""The exceptions with which rclpy ends a spin on Ctrl+C."""

_SHUT_DOWN_TWICE = ("rcl_shutdown already called", "Context must be initialized before it can be shutdown")
_INVALID_CONTEXT = ("context is invalid", "context is not valid", "context argument is null")


def _raised(case: Case) -> Traceback | None:
    """The traceback that the process has written after Ctrl+C: the criterion's own choice."""
    found: Traceback | None = case.about("raised")
    return found


def _traceback(kind: str, message: str = "") -> Traceback:
    return Traceback(kind, message, ())


@mistake(
    "shutdown-after-ctrl-c",
    name="shutdown() after Ctrl+C",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.PROCESS,
    says="{place}rclpy has already shut down on Ctrl+C, so a second shutdown() raises RCLError",
    do="Shut down with the function of rclpy that does so only if it is still needed.",
    remark="{line} raises RCLError when Ctrl+C has already shut rclpy down; rclpy.try_shutdown() does not.",
    example=in_run(Symptom.ENDS_BADLY, raised=_traceback("rclpy._rclpy_pybind11.RCLError", _SHUT_DOWN_TWICE[0])),
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
    raised = _raised(case)
    if raised is not None and any(words in raised.message for words in _SHUT_DOWN_TWICE):
        own = raised.own(case.trace.folder)
        place = f"line {own.line}: " if own is not None else ""
        yield found_at(own, place=place)
    elif case.symptom is Symptom.ENDED and case.trace.exit is None:  # asked for a remark
        for file in case.files:
            for call in file.calls("shutdown"):
                if ast.unparse(call) == "rclpy.shutdown()":
                    yield found(file, call, place="")


@mistake(
    "threads-waited-for-at-exit",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.PROCESS,
    says="main() has ended, but Python still waits for its threads, where nothing catches the KeyboardInterrupt",
    do="Join the threads in main(), and catch KeyboardInterrupt there.",
    example=in_run(
        Symptom.ENDS_BADLY,
        raised=Traceback("KeyboardInterrupt", "", (tracebacks.Frame("/lib/threading.py", 1, "_shutdown", ""),)),
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
    raised = _raised(case)
    if raised is not None and any(
        frame.function == "_shutdown" and frame.path.endswith("/threading.py") for frame in raised.frames
    ):
        yield Found()


@mistake(
    "traceback-on-exit",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.PROCESS,
    says="{exception} reaches the end of the program{place}",
    do="Around the spin, catch what Ctrl+C raises there: KeyboardInterrupt and ExternalShutdownException.",
    example=in_run(Symptom.ENDS_BADLY, raised=_traceback("KeyboardInterrupt")),
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
    raised = _raised(case)
    if raised is not None and raised.type.endswith(SPIN_ENDINGS):
        own = raised.own(case.trace.folder)
        name = raised.type.rpartition(".")[2]
        yield found_at(own, exception=name, place=f" (line {own.line} of {own.name})" if own is not None else "")


@mistake(
    "used-after-shutdown",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.PROCESS,
    says="{exception}{place}: after Ctrl+C a node can neither publish nor log over ROS",
    do="Stop what uses the node before the shutdown, or do without ROS there: print() still works.",
    example=in_run(Symptom.ENDS_BADLY, raised=_traceback("rclpy._rclpy_pybind11.RCLError", _INVALID_CONTEXT[1])),
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
    raised = _raised(case)
    if raised is not None and any(words in raised.message for words in _INVALID_CONTEXT):
        own = raised.own(case.trace.folder)
        place = f" (line {own.line} of {own.name})" if own is not None else ""
        yield found_at(own, exception=raised.raised, place=place)


@mistake(
    "exception-on-exit",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.SYMPTOM,
    says="{exception}{place}, after Ctrl+C",
    do="Let the program end normally after Ctrl+C, which is no error: return from main().",
    example=in_run(Symptom.ENDS_BADLY, raised=_traceback("ValueError", "ding")),
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
    raised = _raised(case)
    if raised is not None:
        own = raised.own(case.trace.folder)
        place = f" (line {own.line} of {own.name})" if own is not None else ""
        yield found_at(own, exception=raised.raised, place=place)
