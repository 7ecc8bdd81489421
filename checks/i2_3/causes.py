"""I2.3: the likely causes of a failure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from checks.i2_3 import steps, tick_steps
from checks.i2_3.callback_groups import diagnose_late_group
from checks.i2_3.facts import SERVICE, SHORTEST_S, TYPE, CallBatch, IdleRun, SingleCalls, right_sum
from checks.i2_3.pace import Fault, TimerPace
from checks.i2_3.rewriting import timer
from checks.i2_3.ticks import HZ, Series
from tutor.judge import causes, tracebacks
from tutor.judge.causes import late_binding, names, slips, spinning
from tutor.judge.causes.period_slips import diagnose_no_autostart, diagnose_self_cancelling, diagnose_twin_timers
from tutor.judge.causes.uncalled import diagnose_awaited_service, diagnose_uncalled_setup
from tutor.judge.causes.unserved import diagnose_unserved
from tutor.judge.rewriting.node import NodeFile, file_calling, file_of, find_in_files, started_node
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause
from tutor.judge.wording import shape
from tutor.ros_model import ServiceEndpoint

BLOCKED_SHARE = 0.75
"""A timer that pauses for less than this share of a call is not blocked by the whole call."""

MIN_REPEATS = 4
"""At least this many lines of the same shape are taken for a timer's."""


def diagnose_no_service(trace: Trace) -> Cause:
    """Why the service is missing."""
    if (broken := causes.diagnose_process(trace) or causes.diagnose_lifecycle(trace)) is not None:
        return broken
    if (early := find_in_files(trace, spinning.diagnose_spin_in_constructor)) is not None:
        return early
    offered = [s for s in trace.graph.servers if not s.is_standard]
    for service in offered:
        if service.name == SERVICE:
            return Cause(
                "wrong type",
                f"{SERVICE} has the type {service.type}, not {TYPE}",
                steps.fix_service(_serving_file(trace))
                or f"create it with AddTwoInts: self.create_service(AddTwoInts, '{SERVICE[1:]}', ...)",
            )
    same_type = [service for service in offered if service.type == TYPE]
    if (unmatched := _diagnose_service_qos(trace)) is not None:
        return unmatched
    for service in same_type or offered:
        return Cause(
            "wrong service name",
            f"there is {service.name} instead of {SERVICE}",
            steps.fix_service(_serving_file(trace))
            or f"name it '{SERVICE[1:]}', spelled exactly like this, without a namespace or ~ in front",
        )
    elsewhere = find_in_files(trace, slips.diagnose_other_domain)
    return (
        elsewhere
        or diagnose_uncalled_setup(_serving_file(trace), "create_service")
        or diagnose_awaited_service(trace)
        or Cause(
            "service missing",
            f"the node is up, but offers no {SERVICE}",
            steps.fix_service(_serving_file(trace))
            or f"in __init__: self.create_service(AddTwoInts, '{SERVICE[1:]}', self.slow_add, callback_group=...)",
        )
    )


def diagnose_no_answer(seen: SingleCalls) -> Cause:
    """Why a call got no answer."""
    if (broken := causes.diagnose_process(seen.trace)) is not None:
        return broken
    if (unmatched := _diagnose_service_qos(seen.trace)) is not None:
        return unmatched
    if (unserved := diagnose_unserved(seen.trace)) is not None:
        return unserved
    if not seen.spins and (empty := find_in_files(seen.trace, steps.diagnose_node_not_added)) is not None:
        return empty
    if not seen.spins or causes.is_in_blocking_call(seen.stuck):
        return _with_step(causes.diagnose_no_answer(seen.trace, seen.stuck), _serving_file(seen.trace))
    blocked = causes.diagnose_blocked(seen.trace, seen.stuck, spins=True)
    if blocked is not None and blocked.name != names.BLOCKED_EXECUTOR:
        return _with_step(blocked, _serving_file(seen.trace))
    if (locked := causes.diagnose_lock_wait(seen.trace, seen.stuck)) is not None:
        return _with_step(replace(locked, name="no answer"), _serving_file(seen.trace))
    own = tracebacks.own_frame(seen.stuck, seen.trace.folder)
    return Cause(
        "no answer",
        f"the callback never returns{f', at {own}' if own else ''}",
        (
            steps.remove_wait(file_of(seen.trace, own), own.code, own.line)
            if own
            else steps.fix_answer(_serving_file(seen.trace))
        )
        or "let the callback wait 3 s, fill in response.sum and return the response; never wait without a timeout",
    )


def _serving_file(trace: Trace) -> NodeFile:
    """The file that creates the service, which the file that was run may import; else the latter."""
    return file_calling(trace, "create_service")


def _with_step(cause: Cause, file: NodeFile) -> Cause:
    """The cause with the step that rewrites the callback, or else all: one service and one timer are all it needs."""
    return replace(cause, hint=steps.fix_answer(file) or cause.hint)


def _diagnose_service_qos(trace: Trace) -> Cause | None:
    """Whether the QoS of the service keeps clients from it."""
    cause = causes.diagnose_incompatible_service(_our_servers(trace))
    return cause and replace(cause, hint=find_in_files(trace, steps.use_default_qos) or cause.hint)


def _our_servers(trace: Trace) -> list[ServiceEndpoint]:
    return [service for service in trace.graph.servers if service.name == SERVICE]


def diagnose_wrong_sum(answer: CallAnswer, trace: Trace) -> Cause:
    """Why the sum may be wrong."""
    assert answer.response is not None
    source = _serving_file(trace)
    if answer.took_s < SHORTEST_S and (early := find_in_files(trace, steps.diagnose_early_answer)) is not None:
        return early
    if (late := late_binding.diagnose_late_binding(trace)) is not None:
        return late
    step = steps.fix_answer(source) or "response.sum = request.a + request.b"
    actual, expected = answer.response["sum"], right_sum(answer)
    if actual == 0:
        return Cause("wrong sum", "the sum is 0: was it put into response.sum?", step)
    return Cause("wrong sum", f"{actual} instead of {expected}", step)


def diagnose_exception(trace: Trace) -> Cause | None:
    """The last uncaught exception of the learner's code in this run: it explains any failure."""
    found = tracebacks.last_traceback(trace)
    return causes.diagnose_traceback(found, trace) if found is not None and not found.ignored else None


def diagnose_other_pace(idle: IdleRun, likely: Series | None) -> Cause:
    """Why no 10 Hz timer was seen while the service was idle."""
    if (broken := causes.diagnose_process(idle.trace)) is not None:
        return broken
    source = file_calling(idle.trace, "create_timer")
    if likely is None and (inactive := causes.diagnose_lifecycle(idle.trace)) is not None:
        return inactive
    if likely is None:
        output_at_exit = idle.ending.output if idle.ending else ()
        lines = Counter(shape(line.text) for line in (*idle.trace.output, *output_at_exit))
        printed = causes.diagnose_printed(
            idle.trace, lambda text: lines[shape(text)] >= MIN_REPEATS, "the repeated message", after=output_at_exit
        )
        return (
            printed
            or diagnose_unserved(idle.trace)
            or find_in_files(idle.trace, diagnose_no_autostart)
            or diagnose_uncalled_setup(source, "create_timer")
            or tick_steps.diagnose_no_ticks(source)
            or Cause(
                "no timer messages",
                "no log message is repeated while nobody calls (debug messages are not shown)",
                tick_steps.rewrite_ticking(source)
                or f"self.create_timer({1 / HZ:g}, self.tick, ...), and log every tenth tick's number at info",
            )
        )
    if likely.hz < HZ and (nap := find_in_files(idle.trace, spinning.diagnose_nap_between_spins)) is not None:
        return nap
    if likely.hz > HZ and (twins := find_in_files(idle.trace, diagnose_twin_timers)) is not None:
        return twins
    if likely.numbered or likely.hz > HZ:
        return Cause(
            "wrong timer period",
            f"the timer ticks {likely.hz:.1f} times per second, not {HZ:g}",
            tick_steps.fix_period(source) or f"create_timer takes the period in seconds: {1 / HZ:g}",
        )
    return Cause(
        "wrong timer period",
        f"{likely.hz:.1f} messages per second, without a number that counts the ticks",
        tick_steps.fix_period(source)
        or f"give the timer a period of {1 / HZ:g} s; if it logs every tenth tick only, put the tick's number in",
    )


def _diagnose_self_cancelling(file: NodeFile) -> Cause | None:
    ticking = timer(file)
    return diagnose_self_cancelling(file, ticking) if ticking is not None else None


def diagnose_disturbed_timer(seen: SingleCalls, pace: TimerPace) -> Cause:
    """Why the timer does not keep its pace during a call."""
    if (broken := causes.diagnose_process(seen.trace)) is not None:
        return broken
    source = _serving_file(seen.trace)
    if pace.fault is not Fault.FAST and (cancelled := find_in_files(seen.trace, _diagnose_self_cancelling)) is not None:
        return cancelled
    if pace.fault is Fault.FAST:
        return Cause(
            "ticks in a burst",
            "more ticks are logged around a call than the timer makes",
            steps.separate_groups(source) or "log ticks in the timer's callback only; do not make up for missed ones",
        )
    if pace.fault is Fault.SLOW:
        return Cause(
            "slowed timer",
            "the timer ticks during a call, but not as often",
            steps.separate_groups(source)
            or "give the timer a callback group of its own and the executor enough threads; let the service sleep",
        )
    if pace.count > 1 and pace.longest_s < BLOCKED_SHARE * pace.for_s:
        return Cause(
            "timer pauses",
            f"the timer goes on during a call, but pauses for {pace.longest_s:.1f} s of it",
            steps.separate_groups(source)
            or "let the two callbacks share no lock, and neither of them wait for the other",
        )
    own = tracebacks.own_frame(seen.stuck, seen.trace.folder)
    where = f", at {own}" if own else ""
    if not seen.stuck:
        return Cause(
            names.BLOCKED_EXECUTOR,
            "the timer stops during a call",
            _use_threads(seen.trace)
            or "use a MultiThreadedExecutor, and put the timer and the service into different callback groups",
        )
    if _in_worker(seen.stuck):
        if (locked := causes.diagnose_lock_wait(seen.trace, seen.stuck)) is not None:
            return locked
        if (late := find_in_files(seen.trace, diagnose_late_group)) is not None:
            return late
        sleeps = own is not None and "sleep" in own.code
        return Cause(
            names.BLOCKED_EXECUTOR,
            f"the timer stops while the service works{where}: {steps.what_timer_waits_for(source, sleeps=sleeps)}",
            steps.separate_groups(source)
            or "give the timer a ReentrantCallbackGroup of its own, and the executor at least 2 threads: num_threads=4",
        )
    return Cause(
        names.BLOCKED_EXECUTOR,
        f"one thread runs all callbacks, and while the service works{where}, the timer waits",
        _use_threads(seen.trace)
        or "use executor = MultiThreadedExecutor(num_threads=4), executor.add_node(node), executor.spin()",
    )


def _use_threads(trace: Trace) -> str | None:
    """The step that lets several threads run the callbacks: in the file that spins the node, or else in its own."""
    return steps.use_threads(file_calling(trace, "spin")) or steps.use_threads(started_node(trace))


def diagnose_lost_calls(trace: Trace, batch: CallBatch, answered: Sequence[CallAnswer]) -> Cause:
    """Why some of three concurrent calls did not get their own sum."""
    if (broken := causes.diagnose_process(trace)) is not None:
        return broken
    source = _serving_file(trace)
    if len(answered) < len(batch.answers):
        return Cause(
            "no answer",
            f"{len(batch.answers) - len(answered)} of {len(batch.answers)} calls made at once got no answer",
            steps.fix_answer(source)
            or "let every call wait its turn or work beside the others, and return its response; refuse none",
        )
    if (
        any(answer.took_s < SHORTEST_S for answer in answered)
        and (early := find_in_files(trace, steps.diagnose_early_answer)) is not None
    ):
        return early
    sums = [answer.response["sum"] for answer in answered if answer.response is not None]
    if any(sums.count(right_sum(answer)) > 1 for answer in answered):
        return Cause(
            "shared state",
            "one call was answered with the sum of another: they share a variable",
            steps.fix_answer(source)
            or "keep a and b in local variables of the callback, not in self: several calls are in it at once",
        )
    return late_binding.diagnose_late_binding(trace) or Cause(
        "wrong sum",
        f"the sums are {', '.join(map(str, sums))}",
        steps.fix_answer(source) or "answer every call with its own a + b, also while another one is being worked on",
    )


def _in_worker(stuck: Sequence[Frame]) -> bool:
    return any(frame.path.endswith("concurrent/futures/thread.py") for frame in stuck)
