"""Programs that do not end on Ctrl+C, or end with the wrong exit code."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Ending, Exit
from tutor.mistakes.entry import Case, Evidence, Found, found, found_at, mistake
from tutor.mistakes.examples import in_run
from tutor.source import calls_in


@mistake(
    "crash-on-exit",
    explains=[Symptom.ENDS_BADLY],
    evidence=Evidence.RUN,
    says="after Ctrl+C the process crashes with {exit}{place}",
    do="End whatever uses the node, such as threads, before you destroy it.",
    example=in_run(Symptom.ENDS_BADLY, ending=Ending(Exit(None, 11, 2.0), 0.2, 5.0)),
)
def crash_on_exit(case: Case) -> Iterator[Found]:
    """The program crashes while it ends.

    Inside, rclpy's objects are C++ objects. If one is destroyed while a thread still uses it, a signal ends the
    process, and there is no exit code of its own.

    Bad:

        node.destroy_node()
        thread.join()

    Good:

        thread.join()
        node.destroy_node()

    See it: Ctrl+C in a terminal, then `echo $?`: 139 is a crash.
    """
    ending = case.about("ending")
    if ending is not None and ending.exit is not None and ending.exit.signal in (6, 7, 11):
        own = tracebacks.own_frame(tracebacks.dumped_frames(ending.output), case.trace.folder)
        place = f", at line {own.line} of {own.name}" if own is not None else ""
        yield found_at(own, exit=ending.exit, place=place)


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
    ending = case.about("ending")
    ended = ending.exit if ending is not None else case.trace.exit
    if ended is None:
        return
    for file in case.files if case.symptom is Symptom.ENDS_BADLY else ():
        for registered in file.calls("signal"):
            handler = registered.args[1] if len(registered.args) == 2 else None
            function = file.function(handler)
            for call in calls_in(function, "exit", "_exit", "SystemExit"):
                if len(call.args) == 1 and ast.unparse(call.args[0]) not in ("0", "None"):
                    yield found(file, call, exit=ended, what=f": line {call.lineno} gives it that code")
    yield Found({"exit": ended, "what": ""})


@mistake(
    "sigint-ignored",
    name="SIGINT ignored",
    explains=[Symptom.DOES_NOT_END],
    evidence=Evidence.SYMPTOM,
    says="the process goes on after Ctrl+C{what}",
    do="Let KeyboardInterrupt end the program, with every loop and thread that it has started.",
    example=in_run(Symptom.DOES_NOT_END),
)
def sigint_ignored(case: Case) -> Iterator[Found]:
    """Ctrl+C does not end the program.

    Ctrl+C sends the signal SIGINT, which Python turns into KeyboardInterrupt. A bare except around the spin, a loop
    that does not ask rclpy.ok(), a thread that runs on, or a signal handler that does nothing keeps the program alive.

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
            match node:
                case ast.ExceptHandler(type=None):
                    yield found(file, node, what=f": the except in line {node.lineno} catches everything")
                case ast.ExceptHandler(type=ast.Name(id="BaseException")):
                    yield found(file, node, what=f": the except in line {node.lineno} catches everything")
        for call in file.calls("signal"):
            if len(call.args) == 2 and ast.unparse(call.args[1]).endswith("SIG_IGN"):
                yield found(file, call, what=f": line {call.lineno} switches SIGINT off")
    yield Found({"what": ""})
