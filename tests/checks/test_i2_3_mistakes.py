"""I2.3: the mistake that is told of a submission's source, for what a check sees of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import pytest

from checks.i2_3_multi_threaded_service import CHECK
from checks.i2_3_multi_threaded_service.calls import CallBatch, right_sum
from checks.i2_3_multi_threaded_service.idle_run import IdleRun
from checks.i2_3_multi_threaded_service.judges import (
    disturbed_timer,
    lost_calls,
    no_answer,
    other_pace,
    waiting_calls,
    wrong_answer,
)
from checks.i2_3_multi_threaded_service.single_calls import SingleCalls
from checks.i2_3_multi_threaded_service.timer_pace import Fault, TimerPace
from tests.checks.builders import EXECUTING
from tests.checks.slow_add import SERVICE, SERVING, answer, series_in, tick_logs
from tutor.judge.symptom import Observation
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.mistakes import catalogues_of, why

SUBMISSIONS = Path(__file__).parents[1] / "submissions" / "i2_3"
FILE, FOLDER = "concurrent_service.py", "/ws"
IN_POOL = Frame("/usr/lib/python3.12/concurrent/futures/thread.py", 1, "_worker", "")

See = Callable[[Trace], Observation]


def run_of(sources: Mapping[str, str]) -> Trace:
    return Trace(FILE, FOLDER, sources=sources, graph=SERVING)


def sources_of(name: str) -> dict[str, str]:
    return {path.name: path.read_text("utf-8") for path in (SUBMISSIONS / name).glob("*.py")}


def stops(trace: Trace, *, pool: bool = True, fault: Fault = Fault.GAP, pause_s: float = 3.0) -> Observation:
    """The timer does not keep its pace in a call of 3 s; the stack dump shows the first sleep of the program."""
    code = trace.sources[FILE].splitlines()
    line = next((number for number, text in enumerate(code, 1) if "sleep(" in text), 1)
    stuck = (Frame(f"{FOLDER}/{FILE}", line, "slow_add", code[line - 1].strip()), EXECUTING, *([IN_POOL] * pool))
    pace = TimerPace(9 if pause_s < 3 else 0, 3.0, pause_s, None, fault)
    return disturbed_timer(SingleCalls(trace, stuck=stuck), pace)


def ticks_at(hz: float, trace: Trace) -> Observation:
    (series,) = series_in(tick_logs(hz=hz, every=1, until_s=10))
    return other_pace(IdleRun(trace), series)


def ticks_never(trace: Trace) -> Observation:
    return other_pace(IdleRun(trace), None)


def calls_take(ratio: float, trace: Trace) -> Observation:
    return waiting_calls(trace, ratio)


def stays_silent(trace: Trace) -> Observation:
    return no_answer(SingleCalls(trace, stuck=(EXECUTING,), spins=False))


def adds_wrongly(sum_: int, trace: Trace) -> Observation:
    return wrong_answer(answer(sum_=sum_), trace)


def mixes_up(trace: Trace) -> Observation:
    sums = [answer(sum_=sum_) for sum_ in (8, 8, 9)]
    assert right_sum(sums[0]) == 8
    return lost_calls(trace, CallBatch(tuple(sums)))


one_after_the_other, two_at_once = partial(calls_take, 3.0), partial(calls_take, 2.0)
alone = partial(stops, pool=False)


@pytest.mark.parametrize(
    ("name", "see", "mistake", "words"),
    [
        # `parallel`
        ("wrong/two-at-a-time", two_at_once, "too-few-threads", "2 threads"),
        ("wrong/one-thread", one_after_the_other, "too-few-threads", "one thread"),
        ("wrong/reentrant-but-one-thread", one_after_the_other, "too-few-threads", "one thread"),
        ("wrong/groups-but-single-threaded-executor", one_after_the_other, "one-thread-for-all-callbacks", "line 36"),
        ("wrong/single-threaded", one_after_the_other, "one-thread-for-all-callbacks", "rclpy.spin(node)"),
        ("wrong/spun-again-beside-its-thread", one_after_the_other, "one-thread-for-all-callbacks", "line 44"),
        ("wrong/rclpy-spin-before-the-executor", one_after_the_other, "one-thread-for-all-callbacks", "line 36"),
        ("wrong/serial-only", one_after_the_other, "one-call-at-a-time", "mutually exclusive"),
        ("wrong/serial-only", two_at_once, "callbacks-wait-for-each-other", "some of three calls"),
        ("wrong/default-group", one_after_the_other, "one-call-at-a-time", "default group"),
        ("wrong/one-group-by-two-names", one_after_the_other, "one-call-at-a-time", "mutually exclusive"),
        ("wrong/groups-after-super", one_after_the_other, "callback-group-set-too-late", "line 24"),
        ("wrong/lock-around-both", one_after_the_other, "lock-held-while-waiting", "self.lock"),
        ("wrong/lock-around-both", two_at_once, "callbacks-wait-for-each-other", "some of three calls"),
        ("wrong/gil-held", one_after_the_other, "callbacks-wait-for-each-other", "all of three calls"),
        ("wrong/autostart-off-and-never-reset", two_at_once, "callbacks-wait-for-each-other", ""),
        ("wrong/sleep-in-the-spin-once-loop", one_after_the_other, "one-call-at-a-time", ""),
        # `timer`, during a call
        ("wrong/default-group", stops, "same-callback-group", "default group"),
        ("wrong/one-group-by-two-names", stops, "same-callback-group", "self.timer_group"),
        ("wrong/three-nodes-tick-in-default-group", stops, "same-callback-group", "line 78"),
        ("wrong/group-as-a-default-argument", stops, "timer-waits-for-the-service", ""),
        ("wrong/groups-from-one-table", stops, "timer-waits-for-the-service", ""),
        ("wrong/one-thread-by-config", stops, "timer-waits-for-the-service", "threads"),
        ("wrong/one-thread", stops, "too-few-threads", "one thread"),
        ("wrong/groups-after-super", stops, "callback-group-set-too-late", "line 25"),
        ("wrong/single-threaded", alone, "one-thread-for-all-callbacks", "line 38"),
        ("wrong/helper-spins-without-its-executor", alone, "one-thread-for-all-callbacks", "running.py, line 13"),
        ("wrong/executor-thread-and-spin-beside-it", alone, "one-thread-for-all-callbacks", "line 60"),
        ("wrong/timer-cancelled-by-call", stops, "timer-cancelled", "slow_callback"),
        ("wrong/timer-stops-after-twenty-ticks", stops, "timer-cancelled", "on_tick"),
        ("wrong/skips-ticks-while-busy", stops, "ticks-dropped", "self.busy"),
        ("wrong/pauses-late-in-a-call", partial(stops, pause_s=1.5), "ticks-dropped", "self.busy"),
        ("wrong/slower-while-busy", partial(stops, fault=Fault.SLOW), "ticks-dropped", "self.running"),
        ("wrong/extra-timer-per-call", partial(stops, fault=Fault.FAST), "timer-for-each-call", "line 25"),
        ("wrong/double-pace-in-call", partial(stops, fault=Fault.FAST), "ticks-in-a-burst", ""),
        ("wrong/gil-held", partial(stops, fault=Fault.SLOW), "slowed-timer", ""),
        ("right/two-nodes", stops, "timer-waits-for-the-service", ""),
        ("right/exclusive-service", stops, "timer-waits-for-the-service", ""),
        # `timer`, while nobody calls
        ("wrong/timer-1-hz", partial(ticks_at, 1.0), "timer-of-another-period", "1.0 times a second"),
        ("wrong/timer-20-hz", partial(ticks_at, 20.0), "timer-of-another-period", "0.05 s"),
        ("wrong/timer-10-s", ticks_never, "timer-of-another-period", "10 s"),
        ("wrong/timer-in-the-base-class-too", partial(ticks_at, 20.0), "two-timers", "line 35"),
        ("wrong/counts-seconds", partial(ticks_at, 1.0), "wrong-rate", "number that it logs"),
        ("wrong/timer-debug", ticks_never, "logged-at-debug", "DEBUG"),
        ("wrong/autostart-off-and-never-reset", ticks_never, "timer-not-started", ""),
        ("wrong/use-sim-time", ticks_never, "simulated-time", ""),
        ("wrong/no-timer", ticks_never, "not-logged", ""),
        # `blocks` and `concurrent`
        ("wrong/node-not-added", stays_silent, "node-not-added-to-the-executor", "executor.spin()"),
        ("wrong/services-of-node-overwritten", stays_silent, "attribute-of-node-overwritten", "self._services"),
        ("wrong/difference", partial(adds_wrongly, 2), "wrong-sum", "req.a - req.b"),
        ("wrong/sum-not-set", partial(adds_wrongly, 0), "response-field-not-set", SERVICE),
        ("wrong/late-binding", partial(adds_wrongly, 15), "late-binding", ""),
        ("wrong/operands-in-self", mixes_up, "shared-state", ""),
    ],
)
def test_mistake_of_a_submission(name: str, see: See, mistake: str, words: str) -> None:
    told = why(see(run_of(sources_of(name))), catalogues_of(CHECK))
    assert told.mistake == mistake, told
    assert words in f"{told.cause} | {told.step}", told
