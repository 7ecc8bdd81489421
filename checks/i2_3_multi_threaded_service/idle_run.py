"""I2.3: the scenario that listens to an idle node until its timer can be recognised, then presses Ctrl+C."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import takewhile

from checks.i2_3_multi_threaded_service.call_scenarios import total_cpu_wait_s, wait_until_spinning
from checks.i2_3_multi_threaded_service.calls import PROGRAM, SERVER, Call
from checks.i2_3_multi_threaded_service.timer_logs import HZ, Series, all_series, timer_series
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import Ending, LogRecord, Trace
from tutor.judge.waiting_for_nodes import CPU_WAIT_SHARE, IDLE_S, IN_FLIGHT_S, wait_until_seen

STARTUP_S = 1.5
"""Messages logged later than this after the first one are not part of the node's startup."""

LISTEN_S = 6.5
"""Long enough to recognise a wrong pace, or a silent timer: even one that logs every fiftieth tick would be heard."""

MESSAGE_GAP_S = 12.0
"""Long enough for a second message of a timer that logs every fiftieth tick."""

ANALYSIS_INTERVAL_S = 0.1
"""Minimum interval between analyses of the logs, which would be costly for each message of a flood."""


@dataclass(frozen=True)
class IdleRun:
    """A run without any call: the timer's log messages, and the shutdown of an idle node.

    `series`: the possible readings of the timer's log messages: all those of 10 Hz, else the likeliest one of another
    pace, if any. `pace_slowed`: the machine may be to blame for that other pace.
    """

    trace: Trace
    series: tuple[Series, ...] = ()
    pace_slowed: bool = False
    ending: Ending | None = None


@repeat_chance_failures
async def run_idle(bench: Bench) -> IdleRun:
    """Listen to the idle node, then press Ctrl+C."""
    async with bench.start(PROGRAM.file) as run:  # start first, like `call_singly`, which waits for these facts
        bench.report_progress(0.1, "waiting for the timer's log messages")
        await wait_until_seen(run, lambda: bool(run.graph.nodes))
        up_at = run.now()
        # A timer needs a node that spins.
        may_tick = (await wait_until_spinning(bench, run)).spins or bool(logs_since(run.logs, up_at))
        since, waited_before_s = run.now(), total_cpu_wait_s(run)
        if may_tick:
            await wait_until_seen(run, lambda: bool(logs_since(run.logs, since)), idle_s=IDLE_S)
        listened_at, cpu_wait_s = run.now(), run.node_cpu_wait_s()
        bench.report_progress(0.3, "listening to the timer")
        if may_tick:
            await _listen(run, since, waited_before_s)
        share = (run.node_cpu_wait_s() - cpu_wait_s) / max(0.1, run.now() - listened_at)
        series = timer_series(all_series(logs_since(run.logs, since)))
        pace_slowed = share >= CPU_WAIT_SHARE and any(_may_be_10_hz(reading, share) for reading in series)
        idle = IdleRun(run.trace(), series, pace_slowed)
        bench.report_progress(0.8, "pressing Ctrl+C")
        return replace(idle, ending=await run.interrupt())


def logs_since(logs: Sequence[LogRecord], since: float) -> Sequence[LogRecord]:
    """The messages logged from `since` on: those of the node's startup, however regular, are no timer's."""
    return [log for log in logs if log.stamp >= since]


def _may_be_10_hz(series: Series, share: float) -> bool:
    """Whether this may yet be a 10 Hz timer, whose node waited for the CPU for this share of the time."""
    return not series.is_10_hz and HZ > series.hz >= (1 - TOLERANCE) * HZ * max(0.05, 1 - share)


async def _listen(run: Run, since: float, waited_before_s: float) -> None:
    """Wait until the logs from `since` on show the timer's pace.

    `waited_before_s`: how long the node and our process had waited for the CPU by then. The timeout starts at `since`
    while there is no log message, and again with the first one, but not before the service is there.
    """
    was_silent, was_up = not logs_since(run.logs, since), not SERVER.missing(run.graph.servers)
    began_at = since if was_silent and was_up else run.now()
    analysed_at, enough = 0.0, False

    def seen_enough() -> bool:
        nonlocal was_silent, was_up, began_at, analysed_at, enough
        if not was_up and not SERVER.missing(run.graph.servers):
            began_at, was_up = run.now(), True
        if run.now() - analysed_at >= ANALYSIS_INTERVAL_S:
            analysed_at = run.now()
            logs = logs_since(run.logs, since)
            if was_silent and logs:
                began_at, was_silent = run.now(), False
            limit_s = _patience_s(logs) + total_cpu_wait_s(run) - waited_before_s
            enough = _is_pace_known(logs) or run.now() - began_at > limit_s
        return enough

    await run.until(seen_enough, 2 * MESSAGE_GAP_S, idle_s=IDLE_S)


def _is_pace_known(logs: Sequence[LogRecord]) -> bool:
    """Whether a 10 Hz timer has been observed long enough to be sure of its pace."""
    return any(
        series.is_10_hz and (series.span_s >= 3.5 or (series.span_s >= 1.8 and series.is_long()))
        for series in all_series(logs)
    )


def _patience_s(logs: Sequence[LogRecord]) -> float:
    """How long to listen. A late message that belongs to no series may be the first of a timer that logs rarely."""
    frequent = [series for series in all_series(logs) if series.is_long()]
    late = [log for log in logs if log.stamp - logs[0].stamp > STARTUP_S]
    if any(not any(series.key.of(log) for series in frequent) for log in late):
        return MESSAGE_GAP_S
    return LISTEN_S


async def listen_until_tick(run: Run, series: Sequence[Series], call: Call) -> Call:
    """Wait for the timer's first message after the call, and for others that arrive together with it."""
    answered_at = call.answer.answered_at

    def seen_enough() -> bool:
        late = takewhile(lambda log: log.received_at > answered_at, reversed(run.logs))
        return any(log.stamp > answered_at and any(reading.key.of(log) for reading in series) for log in late)

    if series:
        await run.until(seen_enough, 1.3 * min(10.0, max(reading.longest_s for reading in series)) + 1.0)
        deadline = run.now() + 2 * IN_FLIGHT_S
        await run.until(lambda: run.now() >= deadline, 1.0)
    return replace(call, until=run.now())
