"""Programs that end by themselves, are killed, or never make a node."""

from __future__ import annotations

import ast
import signal
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import Exit
from tutor.judge.tracebacks import last_traceback
from tutor.mistakes.entry import EVERY_SYMPTOM, Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.ros_model import Graph
from tutor.source import called_name

EXITS = ("exit", "_exit", "quit")
_AFTER_CTRL_C = (Symptom.DOES_NOT_END, Symptom.ENDS_BADLY)
_OF_A_LAUNCH = (Symptom.NOT_LAUNCHED, Symptom.WRONG_NAMES, Symptom.NOT_CONNECTED)
"""A launch that ends by itself is explained by what launch has said."""

_WHILE_RUNNING = tuple(symptom for symptom in EVERY_SYMPTOM if symptom not in (*_AFTER_CTRL_C, *_OF_A_LAUNCH))
_OF_A_CLIENT = (Symptom.CALLS_MISSING, Symptom.RUNS_ON, Symptom.NOT_TOLD, Symptom.WRONG_EXIT_CODE)
WHILE_A_NODE_RUNS = tuple(symptom for symptom in _WHILE_RUNNING if symptom not in _OF_A_CLIENT)
"""A client ends by itself, and gets no arguments from ROS."""

_TORN_THREAD = ("terminate called without an active exception", "FATAL: exception not rethrown")
"""Messages of C++ and glibc when Python, at interpreter exit, stops a thread that is inside rclpy."""


def ended_by_itself(case: Case) -> Exit | None:
    """How the process ended by itself; None if it still runs, or if a traceback says more."""
    says_more = bool(case.exceptions) or last_traceback(case.trace) is not None
    return case.trace.exit if not says_more else None


def how_it_ended(ended: Exit) -> str:
    """When and how a process ended, in words."""
    return f"the program ends by itself after {ended.after_s:.1f} s with {ended}"


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


@mistake(
    "no-main-call",
    slip=True,
    explains=_WHILE_RUNNING,
    evidence=Evidence.PROCESS,
    says="{ended}: {what}",
    do="{do}",
    example=in_run(Symptom.ENDED, exit=Exit(0, None, 0.2), graph=Graph()),
)
def no_main_call(case: Case) -> Iterator[Found]:
    """main() is defined, but nothing calls it.

    Python runs a file from top to bottom; a def only defines a function. What runs it is a call at the end of the file,
    guarded by a test of the variable __name__, which is "__main__" in the file that was started.

    Bad:

        def main():
            ring_the_bell()

    Good:

        def main():
            ring_the_bell()

        if __name__ == '__main__':
            main()

    See it: the program ends at once, without a word.
    """
    if (ended := ended_by_itself(case)) is None:
        return
    do = "Call it from the usual two lines at the end of the file."
    file, words = case.file, {"ended": how_it_ended(ended), "do": do}
    for node in file.nodes:
        match node:
            case ast.If(
                test=ast.Compare(left=ast.Name("__name__"), comparators=[ast.Constant(value=str() as text)])
            ) if text != "__main__":
                fix = {"do": "Compare it with '__main__' there."}
                yield found(file, node, what=f"__name__ is never {text!r} (line {node.lineno})", **words | fix)
    defined = [node for node in file.tree.body if isinstance(node, ast.FunctionDef) and node.name == "main"]
    named = [node for node in file.nodes if isinstance(node, ast.Name) and node.id == "main"]
    bare = [node for node in named if isinstance(next(file.ancestors(node)), ast.Expr)]
    if defined and bare and len(bare) == len(named):
        fix = {"do": "Add the parentheses: main()."}
        yield found(file, bare[0], what=f"line {bare[0].lineno} names main, but does not call it", **words | fix)
    elif defined and not named:
        yield found(file, defined[0], what="main() is defined, but nothing calls it", **words)


@mistake(
    "thread-still-running",
    explains=EVERY_SYMPTOM,
    evidence=Evidence.PROCESS,
    says="the program ended while one of its threads was still spinning, which aborts it with {ended}",
    do="Shut down rclpy or its executor, then join the thread, even a daemon; an interrupted join() does not wait.",
    example=in_run(Symptom.ENDED, exit=Exit(None, 6, 1.0), output=["terminate called without an active exception"]),
)
def torn_thread(case: Case) -> Iterator[Found]:
    """The program ends while a thread is still inside rclpy.

    When the main thread is done, Python stops daemon threads wherever they are. One that is inside rclpy's C++ code
    cannot be stopped there, and the whole process aborts. The same happens to a thread that is no daemon if Ctrl+C
    interrupts its join(): Python 3.12 then takes it for ended, and no later join() waits for it. So let the main thread
    wait in something else, such as time.sleep().

    Bad:

        thread = Thread(target=rclpy.spin, args=(node,), daemon=True)
        thread.start()

    Good:

        thread = Thread(target=rclpy.spin, args=(node,), daemon=True)
        thread.start()
        rclpy.shutdown()
        thread.join()

    See it: "terminate called without an active exception" in the output.
    """
    ending = case.about("ending")
    if ending is None and case.exceptions:
        return  # it ended by that exception
    ended = ending.exit if ending is not None else case.trace.exit
    output = ending.output if ending is not None else case.trace.output
    torn = any(message in line.text for line in output for message in _TORN_THREAD)
    if torn and ended is not None and ended.signal == signal.SIGABRT:
        yield Found({"ended": ended})


@mistake(
    "killed",
    explains=_WHILE_RUNNING,
    evidence=Evidence.PROCESS,
    says="{ended} ({signal})",
    do="Read the last lines of its output; if it happens every time, look for what sends that signal.",
    example=in_run(Symptom.ENDED, exit=Exit(None, 11, 1.0)),
)
def killed(case: Case) -> Iterator[Found]:
    """A signal ended the program.

    The system, another program or the program itself ended it: SIGSEGV is a crash in C or C++ code, often because an
    object was destroyed while another thread used it; SIGKILL comes from outside, or from os.kill in the code.

    Bad:

        os.kill(os.getpid(), signal.SIGTERM)

    Good:

        rclpy.try_shutdown()

    See it: `echo $?` after the program: 128 plus the signal's number.
    """
    ended = ended_by_itself(case)
    if ended is not None and ended.signal is not None:
        yield Found({"ended": how_it_ended(ended), "signal": _signal_name(ended.signal)})


@mistake(
    "arguments-refused",
    explains=WHILE_A_NODE_RUNS,
    evidence=Evidence.PROCESS,
    says="{ended}: {what}",
    do="Leave --ros-args and what follows it to rclpy: parse only the arguments before it, or none.",
    example=in_run(
        Symptom.ENDED, exit=Exit(2, None, 0.2), output=["node.py: error: unrecognized arguments: --ros-args"]
    ),
)
def arguments_refused(case: Case) -> Iterator[Found]:
    """A program refuses the arguments that ROS gives it.

    ROS starts a node with arguments of its own, such as --ros-args -p volume:=7. A parser that does not know them ends
    the program, and so does a check of how many there are.

    Bad:

        options = parser.parse_args()

    Good:

        options, _ = parser.parse_known_args()

    See it: start it with `--ros-args -p volume:=7`.
    """
    if (ended := ended_by_itself(case)) is None:
        return
    errors = [line.text for line in case.trace.output if line.stream == "stderr" and " error: " in line.text]
    if ended.code == 2 and errors:
        yield Found({"ended": how_it_ended(ended), "what": errors[-1].rpartition(" error: ")[2]})
    for file in case.files:
        used = [ast.unparse(node) for node in file.nodes if isinstance(node, ast.Subscript)]
        if any(code.startswith("sys.argv[") and code != "sys.argv[0]" for code in used):
            continue
        for node in file.nodes:
            if isinstance(node, ast.If) and not node.orelse and "len(sys.argv)" in ast.unparse(node.test):
                last = node.body[-1]
                ends = isinstance(last, ast.Raise | ast.Return) or any(
                    isinstance(call, ast.Call) and called_name(call) in EXITS for call in ast.walk(last)
                )
                if ends:
                    what = f"line {node.lineno} counts its arguments, but ROS passes some of its own"
                    yield found(file, node, ended=how_it_ended(ended), what=what)
