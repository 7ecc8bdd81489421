"""Causes that concern the process and its nodes as such, in any exercise."""

from __future__ import annotations

import ast
import signal
from collections.abc import Sequence
from dataclasses import replace

from tutor.judge import tracebacks
from tutor.judge.causes import callback_slips, names, slips, spinning
from tutor.judge.causes.blocking import diagnose_blocked
from tutor.judge.causes.exceptions import diagnose_known_exception, diagnose_traceback
from tutor.judge.causes.logged_exceptions import diagnose_logged_exception
from tutor.judge.causes.unserved import diagnose_unserved
from tutor.judge.edits import remove_statement
from tutor.judge.rewriting.node import find_in_files, started_node
from tutor.judge.rewriting.program import call_main, first_sound_step, whole_program
from tutor.judge.source import called_name
from tutor.judge.trace import Exit, OutputLine, Trace
from tutor.judge.tracebacks import Frame, Traceback
from tutor.judge.verdict import Cause

QUICK_S = 3.0
"""A process that ends by itself within this many seconds of its start has ended "at once"."""

_TORN_THREAD_MESSAGES = ("terminate called without an active exception", "FATAL: exception not rethrown")
"""Messages of C++ and glibc when Python, at interpreter exit, stops a thread that is inside rclpy."""


def diagnose_process(trace: Trace) -> Cause | None:
    """Why the process as such failed: it could not start, crashed, ended, or never created a node."""
    found = tracebacks.last_traceback(trace)
    if found is not None:
        return diagnose_traceback(found, trace)
    if trace.exit is not None:
        return _diagnose_exit(trace)
    if not trace.graph.nodes:
        file = started_node(trace)
        return slips.diagnose_other_domain(file) or Cause(
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
    if trace.exit.code == 0 and (guard := slips.diagnose_main_guard(started_node(trace))) is not None:
        return replace(guard, text=f"{ended}: {guard.text}")
    if (torn := diagnose_torn_thread(trace.exit, trace.output)) is not None:
        return torn
    if trace.exit.signal == signal.SIGKILL:
        step = "it happens on each start: look for what sends SIGKILL, os.kill in your code or a tool on this machine"
        return Cause("killed", f"{ended} (SIGKILL)", step)
    if trace.exit.signal is not None:
        return Cause("killed", f"{ended} ({_signal_name(trace.exit.signal)})", "see the last lines of its output")
    if (found := _diagnose_usage(trace) or diagnose_logged_exception(trace)) is not None:
        return found
    if (guard := slips.diagnose_argument_guard(started_node(trace))) is not None:
        return replace(guard, text=f"{ended}: {guard.text}")
    if trace.exit.code == 0 and (early_end := spinning.diagnose_early_end(trace, ended)) is not None:
        return early_end
    if (exits := find_in_files(trace, lambda file: callback_slips.diagnose_exit_in_callback(file, ended))) is not None:
        return exits
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
    """Whether the program rejected its command line as argparse does: with a message and exit code 2."""
    errors = [line.text for line in trace.output if line.stream == "stderr" and " error: " in line.text]
    assert trace.exit is not None
    if trace.exit.code != 2 or not errors:
        return None
    return diagnose_known_exception(Traceback("SystemExit", errors[-1], ()), trace)


def diagnose_torn_thread(process_exit: Exit, output: Sequence[OutputLine]) -> Cause | None:
    """Whether the program aborted because it ended while one of its daemon threads was inside rclpy."""
    torn = any(message in line.text for line in output for message in _TORN_THREAD_MESSAGES)
    if process_exit.signal != signal.SIGABRT or not torn:
        return None
    return Cause(
        "thread still running",
        f"the process ended after {process_exit.after_s:.1f} s with {process_exit}: the program ended while one of its "
        "threads was still spinning, which aborts it",
        "end that thread first: call rclpy.shutdown() or executor.shutdown(), then thread.join(), also for a daemon",
    )


def describe_no_answer(trace: Trace, waited_s: float) -> str:
    """Say that a request got no answer within this time, or because the process had already ended."""
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

    `stuck`: a stack dump of its threads, innermost frame first (`Run.dump_stacks`). `spins`: it has answered a request
    before.
    """
    broken = diagnose_process(trace)
    if broken is not None:
        return broken
    return (
        diagnose_logged_exception(trace)
        or diagnose_unserved(trace)
        or diagnose_blocked(trace, stuck, spins=spins)
        or spinning.diagnose_not_spinning(trace, stuck, node_names(trace))
        or diagnose_no_spin(trace)
    )


def diagnose_same_name(trace: Trace) -> Cause | None:
    """Two nodes have the same name: both publish, and a client cannot tell which one answers its requests."""
    nodes = trace.graph.nodes
    twice = sorted({node for node in nodes if nodes.count(node) > 1})
    if not twice:
        return None
    return Cause(
        names.SAME_NAME,
        f"there are {nodes.count(twice[0])} nodes called {twice[0]}, and all of them are active",
        _remove_second_node(trace)
        or "make one node only; is the class instantiated twice, or the program started twice?",
    )


def _remove_second_node(trace: Trace) -> str | None:
    """The step that removes further instances of a node class, and the lines that use them; None if there are none."""
    file = started_node(trace)
    made = file.calls(*file.node_classes)
    extra = [each for at, each in enumerate(made) if called_name(each) in map(called_name, made[:at])]
    extra_names = {name for each in extra if (name := file.assigned_to(each))}
    uses = [each for each in ast.walk(file.tree) if isinstance(each, ast.Name) and each.id in extra_names]
    statements = {file.statement(each) for each in (*extra, *uses)}
    return file.step([remove_statement(file.text, each) for each in statements])


def output_tail(trace: Trace, max_lines: int = 6) -> tuple[str, ...]:
    """The last non-empty lines that the process wrote, as evidence."""
    return tuple(line.text for line in trace.output if line.text.strip())[-max_lines:]


def node_names(trace: Trace) -> str:
    """The nodes' names, for use in a sentence."""
    return "the node " + ", ".join(trace.graph.nodes) if trace.graph.nodes else "the node"


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
