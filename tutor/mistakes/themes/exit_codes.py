"""Programs that end on Ctrl+C with the wrong exit code."""

from __future__ import annotations

import ast
import signal
from collections.abc import Iterator
from dataclasses import replace

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Ending, Exit
from tutor.mistakes.entry import Case, Evidence, Found, found, found_at, mistake
from tutor.mistakes.examples import in_run
from tutor.source import NodeFile, calls_in

_EXITS = ("exit", "_exit", "SystemExit")
_CRASHES = (signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT)


def _exit(case: Case) -> Exit | None:
    ending: Ending | None = case.about("ending")
    return ending.exit if ending is not None else case.trace.exit


@mistake(
    "crash-on-exit",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.RUN,
    says="after Ctrl+C the process crashes with {exit}{place}",
    do="{do}",
    example=in_run(Symptom.ENDS_BADLY, ending=Ending(Exit(None, 11, 2.0), 0.2, 5.0)),
)
def crash_on_exit(case: Case) -> Iterator[Found]:
    """The program crashes while it ends.

    Inside, rclpy's objects are C++ objects. If one is destroyed while a thread still uses it, a signal ends the
    process, and there is no exit code of its own; os.abort() does the same.

    Bad:

        node.destroy_node()
        thread.join()

    Good:

        thread.join()
        node.destroy_node()

    See it: Ctrl+C in a terminal, then `echo $?`: 139 is a crash.
    """
    ending, ended = case.about("ending"), _exit(case)
    if ending is None or ended is None or ended.signal not in _CRASHES:
        return
    dumped = tracebacks.dumped_frames(ending.output)
    own = [
        replace(frame, code=case.program.named(frame.name).line(frame.line))
        for frame in dumped
        if tracebacks.is_in_folder(frame.path, case.trace.folder)
    ]
    aborting = next((frame for frame in own if "abort(" in frame.code), None)
    at = aborting or next(iter(own), None)
    do = "End whatever uses the node, such as threads, before you destroy it."
    if aborting is not None:
        do = "Let the program end there without aborting: Ctrl+C is a normal end, and no error."
    yield found_at(at, exit=ended, place=f" ({at})" if at is not None else "", do=do)


@mistake(
    "non-zero-exit",
    name="non-zero exit",
    explains=[Symptom.ENDS_BADLY, Symptom.WRONG_EXIT_CODE],
    evidence=Evidence.SYMPTOM,
    says="the process ends with {exit}{what}",
    do="Return normally from main(), and give exit() no code but 0.",
    example=in_run(Symptom.ENDS_BADLY, ending=Ending(Exit(3, None, 2.0), 0.2, 5.0)),
)
def nonzero_exit(case: Case) -> Iterator[Found]:
    """A program that was told to end has an exit code that says it failed.

    Whatever started the program, such as a launch file or a script, sees its exit code. 0 says that all went well, and
    130 that Ctrl+C ended it; sys.exit(True) and exit(signum) say that something failed.

    Bad:

        signal.signal(signal.SIGINT, lambda number, frame: sys.exit(number))

    Good:

        signal.signal(signal.SIGINT, lambda number, frame: sys.exit(0))

    See it: Ctrl+C in a terminal, then `echo $?`.
    """
    ended = _exit(case)
    if ended is None:
        return
    for file in case.files:
        for call in _exits(file, ended):
            what = f", and line {call.lineno} gives it that code: {file.line(call.lineno)}"
            yield found(file, call, exit=ended, what=what)
    yield Found({"exit": ended, "what": ""})


def _exits(file: NodeFile, ended: Exit) -> Iterator[ast.Call]:
    """The calls that may have ended a program with its exit code, those in a signal handler first."""
    handlers = [registered.args[1] for registered in file.calls("signal") if len(registered.args) == 2]
    inside = [handler if isinstance(handler, ast.Lambda) else file.function(handler) for handler in handlers]
    calls = [call for function in inside for call in calls_in(function, *_EXITS)]
    for call in (*calls, *file.calls(*_EXITS)):
        if len(call.args) == 1 and _may_be(file, call.args[0], ended.code):
            yield call


def _may_be(file: NodeFile, given: ast.expr, code: int | None) -> bool:
    """Whether what is given to exit() may be this exit code."""
    match given:
        case ast.Constant(value=str()):
            return code == 1
        case ast.Constant(value=value):
            return (value or 0) == code
        case ast.Call(func=called):
            function = file.function(called)
            returned = [node.value for node in ast.walk(function) if isinstance(node, ast.Return)] if function else []
            values = [value for value in returned if value is not None]
            return any(isinstance(value, ast.Call) or _may_be(file, value, code) for value in values)
    return code is not None
