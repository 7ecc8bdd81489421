"""Causes that lie with the process and its nodes as such, whatever the exercise asks of them."""

from __future__ import annotations

import ast
import signal
from collections.abc import Sequence

from tutor.judge import tracebacks
from tutor.judge.causes import names, spinning
from tutor.judge.causes.blocking import diagnose_blocked
from tutor.judge.causes.exceptions import diagnose_known_exception, diagnose_traceback
from tutor.judge.edits import remove_statement
from tutor.judge.rewriting.node import started_node
from tutor.judge.rewriting.program import call_main, first_sound_step, whole_program
from tutor.judge.source import called_name
from tutor.judge.trace import Exit, OutputLine, Trace
from tutor.judge.tracebacks import Frame, Traceback
from tutor.judge.verdict import Cause

QUICK_S = 3.0
"""A process that ends by itself within this many seconds of its start ended "at once"."""

_TORN_THREAD = ("terminate called without an active exception", "FATAL: exception not rethrown")
"""What C++ and glibc write where Python, at its end, stops a thread that is inside rclpy."""


def diagnose_process(trace: Trace) -> Cause | None:
    """Why the process as such did not do its work: it could not start, broke, ended, or never made a node."""
    found = tracebacks.last_traceback(trace)
    if found is not None:
        return diagnose_traceback(found, trace)
    if trace.exit is not None:
        return _diagnose_exit(trace)
    if not trace.graph.nodes:
        return Cause(
            "no node",
            f"the process runs, but made no ROS node{' and prints without end' if trace.dropped_lines else ''}",
            first_sound_step(trace, whole_program)
            or "call rclpy.init(), create your node, then rclpy.spin(node); a loop before that keeps it from happening",
        )
    return None


def _diagnose_exit(trace: Trace) -> Cause:
    assert trace.exit is not None
    ended = f"the process ended after {trace.exit.after_s:.1f} s with {trace.exit}"
    if trace.uncalled_main:
        return Cause(
            "no main call",
            f"{ended}: main() is defined, but nothing calls it",
            first_sound_step(trace, call_main) or 'end the file with: if __name__ == "__main__": main()',
        )
    if (torn := diagnose_torn_thread(trace.exit, trace.output)) is not None:
        return torn
    if trace.exit.signal == signal.SIGKILL:
        who = "it happens on each start: look for what sends SIGKILL, os.kill in your code or a tool on this machine"
        return Cause("killed", f"{ended} (SIGKILL)", who)
    if trace.exit.signal is not None:
        return Cause("killed", f"{ended} ({_signal_name(trace.exit.signal)})", "see the last lines of its output")
    if (refused := _diagnose_usage(trace)) is not None:
        return refused
    if trace.exit.code == 0 and (unspun := spinning.diagnose_early_end(trace, ended)) is not None:
        return unspun
    if trace.exit.code == 0 and trace.exit.after_s <= QUICK_S + 0.5:
        return Cause(
            names.EXIT_AT_ONCE,
            f"{ended}, without an error",
            first_sound_step(trace, whole_program)
            or "a node lives as long as rclpy.spin(node) runs: is it called, and is anything ending it?",
        )
    step = (
        first_sound_step(trace, whole_program)
        or "let rclpy.spin(node) run until Ctrl+C; see the last lines of its output"
    )
    return Cause(names.EXIT_AT_ONCE, ended, step)


def _diagnose_usage(trace: Trace) -> Cause | None:
    """Whether the program refused its command line, as argparse and others do: with a message, and exit code 2."""
    said = [line.text for line in trace.output if line.stream == "stderr" and " error: " in line.text]
    assert trace.exit is not None
    return (
        diagnose_known_exception(Traceback("SystemExit", said[-1], ()), trace)
        if trace.exit.code == 2 and said
        else None
    )


def diagnose_torn_thread(ended: Exit, output: Sequence[OutputLine]) -> Cause | None:
    """Whether the program aborted because it came to its end while a daemon thread of its own was inside rclpy."""
    if ended.signal != signal.SIGABRT or not any(words in line.text for line in output for words in _TORN_THREAD):
        return None
    return Cause(
        "thread still running",
        f"the process ended after {ended.after_s:.1f} s with {ended}: the program came to its end while a thread of "
        "its own was still spinning, which aborts it",
        "end that thread first: call rclpy.shutdown() or executor.shutdown(), then thread.join(), also for a daemon",
    )


def describe_no_answer(trace: Trace, waited_s: float) -> str:
    """That a request got no answer in this time, or since the process had ended before."""
    if trace.exit is None:
        return f"no answer in {waited_s:.2g} s"
    return f"no answer: the process ended by itself, {trace.exit.after_s:.1f} s after its start, with {trace.exit}"


def diagnose_no_spin(trace: Trace) -> Cause:
    """The node exists, but none of its callbacks ever runs."""
    return Cause(
        names.NO_SPIN,
        f"{node_names(trace)} exists, but answers no request: its callbacks are never run",
        first_sound_step(trace, whole_program)
        or "call rclpy.spin(node) (or executor.spin()) after creating the node, and let no callback block",
    )


def diagnose_no_answer(trace: Trace, stuck: Sequence[Frame], *, spins: bool = False) -> Cause:
    """Why a node that is up answers no request (any more).

    `stuck`: where its threads were meanwhile, innermost frame first (`Run.dump_stacks`). `spins`: it has answered
    before.
    """
    broken = diagnose_process(trace)
    if broken is not None:
        return broken
    return (
        diagnose_blocked(trace, stuck, spins=spins)
        or spinning.diagnose_not_spinning(trace, stuck, node_names(trace))
        or diagnose_no_spin(trace)
    )


def diagnose_same_name(trace: Trace) -> Cause | None:
    """Two nodes under one name: both publish, and anyone who asks one of them cannot tell which answers."""
    nodes = trace.graph.nodes
    twice = sorted({node for node in nodes if nodes.count(node) > 1})
    if not twice:
        return None
    return Cause(
        names.SAME_NAME,
        f"there are {nodes.count(twice[0])} nodes called {twice[0]}, and all of them are at work",
        _one_only(trace) or "make one node only; is the class instantiated twice, or the program started twice?",
    )


def _one_only(trace: Trace) -> str | None:
    """The step where a second node is made of the same class: that line goes, and those that use the node."""
    file = started_node(trace)
    made = file.calls(*file.node_classes)
    extra = [each for at, each in enumerate(made) if called_name(each) in map(called_name, made[:at])]
    names_of = {kept for each in extra if (kept := file.assigned_to(each))}
    used = [each for each in ast.walk(file.tree) if isinstance(each, ast.Name) and each.id in names_of]
    statements = {file.statement(each) for each in (*extra, *used)}
    return file.step([remove_statement(file.text, each) for each in statements])


def output_tail(trace: Trace, most: int = 6) -> tuple[str, ...]:
    """The last lines that the process wrote, as evidence."""
    return tuple(line.text for line in trace.output if line.text.strip())[-most:]


def node_names(trace: Trace) -> str:
    """The nodes, to be named in a sentence."""
    return "the node " + ", ".join(trace.graph.nodes) if trace.graph.nodes else "the node"


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
