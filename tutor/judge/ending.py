"""The `shutdown` criterion, which means the same in every exercise: a clean end on Ctrl+C."""

from __future__ import annotations

import signal
from functools import wraps
from typing import Protocol

from tutor.judge import causes, shutdown_steps, tracebacks
from tutor.judge.bench import Bench, Scenario
from tutor.judge.trace import Ending, Exit, Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed

_CRASHES = signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT
_CONTEXT_GONE = "the given context is not valid"
_AGAIN = 2
"""This many more starts are looked at, at most, where it may be chance that a process did not end cleanly on Ctrl+C."""

_CONTEXT_OVER = "context is invalid", "context is not valid", "context argument is null"
_ENDS_A_SPIN = "KeyboardInterrupt", "ExternalShutdownException"
"""What rclpy ends a spin with on Ctrl+C."""

_SHUT_DOWN_TWICE = "rcl_shutdown already called", "Context must be initialized before it can be shutdown"
EXPECTED = "on Ctrl+C the process ends within {limit:g} s, without a traceback, with exit code 0 or 130"


class _Ended(Protocol):
    @property
    def ending(self) -> Ending | None: ...


def repeat_if_doubtful[T: _Ended](scenario: Scenario[T]) -> Scenario[T]:
    """The scenario, whose process ends on Ctrl+C; where it ended as a right program may by chance, seen on more starts.

    Gives the facts of one that ended so again, or else of one that did not. A mistake of the learner's shows each time.
    What was seen once in some hundred runs, most of them on a busy machine, where the learner's code is right:

    - a crash: a thread of rclpy's own walks its list of guard conditions, which `executor.shutdown()` may be freeing
      (signal_handler.cpp of rclpy 7.1.6);
    - an abort: a `thread.join(timeout)` that KeyboardInterrupt ends takes the thread for stopped, so that a second
      `join()` does not wait for it (threading.py of CPython 3.12);
    - an RCLError from `spin()` in a thread: the context is shut down after it has asked for it, and before it waits;
    - an RCLError from `try_shutdown()`, for the same reason. `judge` forgives it, but it hides what would come after.
    """

    @wraps(scenario)
    async def look(bench: Bench) -> T:
        seen = await scenario(bench)
        if may_be_chance(seen.ending):
            for _ in range(_AGAIN):
                bench.report_progress(0.9, "it did not end cleanly on Ctrl+C: looking whether it does so again")
                seen = await scenario(bench)
                if may_be_chance(seen.ending):
                    break
        return seen

    return look


def may_be_chance(ending: Ending | None) -> bool:
    """Whether the process ended as a right program may by chance (see `repeat_if_doubtful`)."""
    found = tracebacks.find_tracebacks(ending.output) if ending is not None else []
    return all(_spun_on(each) or _race_in_rclpy(each) for each in found) if found else _crashed(ending)


def _spun_on(found: tracebacks.Traceback) -> bool:
    """Whether an executor of rclpy's was about to wait when the context was shut down."""
    executing = any(frame.path.endswith("rclpy/executors.py") for frame in found.frames)
    return executing and _CONTEXT_GONE in found.message


def _crashed(ending: Ending | None) -> bool:
    """Whether the process died within C or C++ code."""
    return ending is not None and ending.exit is not None and ending.exit.signal in _CRASHES


def judge_ending(trace: Trace, ending: Ending | None) -> Verdict:
    """Judge how a process ended. `ending` is None where it had ended by itself before Ctrl+C could be pressed."""
    expected = EXPECTED.format(limit=ending.limit_s if ending else 5)
    if ending is None:
        cause = causes.diagnose_process(trace) or Cause(
            "exit at once", "the process had ended before Ctrl+C was pressed", "let the node run until Ctrl+C"
        )
        return failed(expected, f"ended by itself with {trace.exit}", cause, causes.output_tail(trace))
    if ending.exit is None:
        return failed(
            expected,
            f"still running {ending.limit_s:g} s after Ctrl+C",
            Cause(
                "SIGINT ignored",
                "the process goes on after Ctrl+C",
                shutdown_steps.allow_interrupt(trace),
            ),
            causes.output_tail(trace),
        )
    found = [each for each in tracebacks.find_tracebacks(ending.output) if not _is_from_rclpy_clean_up(each, trace)]
    observed = f"ended {ending.took_s:.2f} s after Ctrl+C with {ending.exit}"
    if found and not _race_in_rclpy(found[-1]):
        return failed(
            expected, f"{observed} and a traceback", _diagnose_traceback(found[-1], trace), [found[-1].raised]
        )
    if ending.exit.code in (0, 130) or ending.exit.signal == 2 or (found and ending.exit.code == 1):
        return passed(expected, observed)
    other = Cause(
        "non-zero exit",
        f"the process ended with {ending.exit}",
        shutdown_steps.exit_with_zero(trace),
    )
    crash = _diagnose_crash(ending.exit, ending, trace) if _crashed(ending) else None
    cause = causes.diagnose_torn_thread(ending.exit, ending.output) or crash or other
    return failed(expected, observed, cause, causes.output_tail(trace))


def _diagnose_crash(ended: Exit, ending: Ending, trace: Trace) -> Cause:
    own = tracebacks.own_frame(tracebacks.dumped_frames(ending.output), trace.folder)
    return Cause(
        "non-zero exit",
        f"after Ctrl+C the process crashes with {ended}" + (f", at {own}" if own else ""),
        shutdown_steps.exit_with_zero(trace),
    )


def _is_from_rclpy_clean_up(found: tracebacks.Traceback, trace: Trace) -> bool:
    """Whether Python reports this from the clean-up of an object of rclpy's, with no line of the learner's in it.

    Seen once in 200 runs with a fast timer (rclpy 7.1.6).
    """
    return found.ignored and not found.at_exit and found.own(trace.folder) is None


def _race_in_rclpy(found: tracebacks.Traceback) -> bool:
    """Whether this is rclpy's own race, where the learner's code is right.

    `try_shutdown()` asks whether the context is up, and the signal handler's thread shuts it down before the next
    instruction. Seen in 1 of 400 runs, more often with many starts at once (rclpy 7.1.6).
    """
    return any(frame.function == "try_shutdown" for frame in found.frames) and "already called" in found.message


def _diagnose_traceback(found: tracebacks.Traceback, trace: Trace) -> Cause:
    own = found.own(trace.folder)
    if any(words in found.message for words in _SHUT_DOWN_TWICE):
        return Cause(
            "shutdown() after Ctrl+C",
            "rclpy has shut its context down already when Ctrl+C arrives, so rclpy.shutdown() raises RCLError",
            shutdown_steps.catch_interrupt(trace),
        )
    if any(found.type.endswith(name) for name in _ENDS_A_SPIN):
        return Cause(
            "traceback on exit",
            f"{found.type.rsplit('.', 1)[-1]} reaches the end of the program" + (f" ({own})" if own else ""),
            shutdown_steps.catch_interrupt(trace),
        )
    known = (
        causes.diagnose_known_exception(found, trace)
        if not any(words in found.message for words in _CONTEXT_OVER)
        else None
    )
    return Cause(
        "traceback on exit",
        f"{found.raised}" + (f" ({own})" if own else ""),
        known.hint if known and not shutdown_steps.is_raise(own) else shutdown_steps.remove_line(trace, own),
    )
