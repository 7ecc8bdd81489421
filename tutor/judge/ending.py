"""The `shutdown` criterion, the same in every exercise: a clean exit on Ctrl+C."""

from __future__ import annotations

import signal
from collections.abc import Sequence
from dataclasses import replace
from functools import wraps
from typing import Protocol

from tutor.judge import tracebacks
from tutor.judge.bench import Bench, Scenario
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Ending, OutputLine, Trace
from tutor.judge.verdict import Verdict, failed, passed, skipped
from tutor.judge.waiting_for_nodes import CPU_WAIT_SHARE
from tutor.judge.wording import output_tail

_CRASH_SIGNALS = signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT
_SPIN_WITHOUT_CONTEXT = "the given context is not valid"
_MAX_RETRIES = 2
"""How often to restart a process whose unclean exit on Ctrl+C may have been a race outside the learner's code."""

SPIN_ENDINGS = ("KeyboardInterrupt", "ExternalShutdownException")
"""The exceptions that rclpy ends a spin with on Ctrl+C."""

EXPECTED = "on Ctrl+C the process ends within {limit:g} s, without a traceback, with exit code 0 or 130"


class _Ended(Protocol):
    @property
    def ending(self) -> Ending | None: ...


def repeat_chance_failures[T: _Ended](scenario: Scenario[T]) -> Scenario[T]:
    """Repeat a scenario that ends with Ctrl+C when its process failed in a way that a correct program may, by a race.

    The result is the facts of the first repetition that fails that way again, else those of the last one. A mistake of
    the learner's shows every time. These races hit correct programs about once in some hundred runs, mostly on a busy
    machine:

    - a crash: one of rclpy's own threads walks its list of guard conditions while `executor.shutdown()` frees them
      (signal_handler.cpp of rclpy 7.1.6);
    - an abort: a `thread.join(timeout)` interrupted by KeyboardInterrupt marks the thread as stopped, so that a second
      `join()` does not wait for it (threading.py of CPython 3.12);
    - an RCLError from `spin()` in a thread: the context is shut down between its check of the context and its wait;
    - an RCLError from `try_shutdown()`, for the same reason. `judge_ending` forgives it, but it hides what follows;
    - a process that goes on forever: seen on a busy machine only, in 1 of 150 checks with twelve at a time.
    """

    @wraps(scenario)
    async def run_until_confirmed(bench: Bench) -> T:
        seen = await scenario(bench)
        if may_be_chance(seen.ending):
            for _ in range(_MAX_RETRIES):
                bench.report_progress(0.9, "it did not end cleanly on Ctrl+C: checking whether that happens again")
                seen = await scenario(bench)
                if may_be_chance(seen.ending):
                    break
        return seen

    return run_until_confirmed


def may_be_chance(ending: Ending | None) -> bool:
    """Whether the process failed in a way that a correct program may, by a race (see `repeat_chance_failures`)."""
    if ending is not None and ending.exit is None:
        return ending.cpu_wait_share >= CPU_WAIT_SHARE
    if ending is None or not tracebacks.find_tracebacks(ending.output):
        return _crashed(ending)
    return is_race(ending.output)


def is_race(output: Sequence[OutputLine]) -> bool:
    """Whether there are tracebacks in this output, all of races in rclpy when the context is shut down."""
    found = tracebacks.find_tracebacks(output)
    return bool(found) and all(_is_race_in_spin(traceback) or _is_race_in_shutdown(traceback) for traceback in found)


def _is_race_in_spin(found: tracebacks.Traceback) -> bool:
    """Whether the context was shut down just as an rclpy executor was about to wait."""
    executing = any(frame.path.endswith("rclpy/executors.py") for frame in found.frames)
    return executing and _SPIN_WITHOUT_CONTEXT in found.message


def _crashed(ending: Ending | None) -> bool:
    """Whether the process was killed by a crash in C or C++ code."""
    return ending is not None and ending.exit is not None and ending.exit.signal in _CRASH_SIGNALS


def judge_ending(trace: Trace, ending: Ending | None, *, shown_by: str) -> Verdict:
    """Judge how a process ended on Ctrl+C.

    `ending` is None if the process had ended by itself before: that is no ending on Ctrl+C, and `shown_by` is the id of
    the criterion that shows why.
    """
    if ending is None:
        how = f", with {trace.exit}" if trace.exit is not None else ""
        return skipped(f"not judged, because the process had ended before Ctrl+C{how}: `{shown_by}` shows why")
    expected = EXPECTED.format(limit=ending.limit_s)
    if ending.exit is None:
        goes_on = Symptom.DOES_NOT_END.seen(trace, ending=ending, raised=None)
        return failed(expected, f"still running {ending.limit_s:g} s after Ctrl+C", goes_on, output_tail(trace))
    seen = tracebacks.find_tracebacks(ending.output) or _find_printed_endings(ending)
    found = [traceback for traceback in seen if not _is_from_rclpy_cleanup(traceback, trace)]
    observed = f"ended {ending.took_s:.2f} s after Ctrl+C with {ending.exit}"
    if found and not _is_race_in_shutdown(found[-1]):
        raised = Symptom.ENDS_BADLY.seen(trace, ending=ending, raised=found[-1])
        return failed(expected, f"{observed} and a traceback", raised, [found[-1].raised])
    if ending.exit.code in (0, 130) or ending.exit.signal == 2 or (found and ending.exit.code == 1):
        return passed(expected, observed)
    return failed(expected, observed, Symptom.ENDS_BADLY.seen(trace, ending=ending, raised=None), output_tail(trace))


def _find_printed_endings(ending: Ending) -> list[tracebacks.Traceback]:
    """The tracebacks of the exceptions of Ctrl+C on stdout.

    Others may be older, of exceptions that the program has dealt with: what it prints is held back in a buffer.
    """
    printed = [replace(line, stream="stderr") for line in ending.output if line.stream == "stdout"]
    return [traceback for traceback in tracebacks.find_tracebacks(printed) if traceback.type.endswith(SPIN_ENDINGS)]


def _is_from_rclpy_cleanup(found: tracebacks.Traceback, trace: Trace) -> bool:
    """Whether this is an ignored exception from the cleanup of an rclpy object, without any line of the learner's.

    Seen once in 200 runs with a fast timer (rclpy 7.1.6).
    """
    return (
        found.ignored and not found.at_exit and not _is_from_wait_for_threads(found) and found.own(trace.folder) is None
    )


def _is_from_wait_for_threads(found: tracebacks.Traceback) -> bool:
    """Whether Ctrl+C interrupted Python while it waited, at the end of the program, for the other threads."""
    return any(frame.function == "_shutdown" and frame.path.endswith("/threading.py") for frame in found.frames)


def _is_race_in_shutdown(found: tracebacks.Traceback) -> bool:
    """Whether this is rclpy's own race, which hits correct programs too.

    `try_shutdown()` checks that the context is up, and the signal handler's thread shuts it down before the next
    instruction. Seen in 1 of 400 runs, more often when many processes start at once (rclpy 7.1.6).
    """
    return any(frame.function == "try_shutdown" for frame in found.frames) and "already called" in found.message
