"""Timers that do not keep their pace while another callback works."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run


@mistake(
    "ticks-in-a-burst",
    explains=[Symptom.STANDS_STILL],
    evidence=Evidence.SYMPTOM,
    says="around a call, more ticks are logged than the timer can make",
    do="Log ticks only in the timer's callback, and do not make up for missed ones.",
    example=in_run(Symptom.STANDS_STILL, pace="fast", stops=False),
)
def burst(case: Case) -> Iterator[Found]:
    """More ticks are logged than the timer makes.

    A timer that could not run does not catch up: missed ticks are gone. Messages that make up for them, or that other
    code logs in the timer's name, hide that the timer stood still.

    Bad:

        def after_the_work(self):
            for _ in range(self.missed):
                self.blink()

    Good:

        def after_the_work(self):
            self.get_logger().info(f'{self.missed} blinks were missed')

    See it: the time stamps of the log around a call.
    """
    if case.about("pace") == "fast":
        yield Found()


@mistake(
    "slowed-timer",
    explains=[Symptom.STANDS_STILL],
    evidence=Evidence.SYMPTOM,
    says="the timer ticks during a call, but less often than outside one",
    do="Let the service's callback sleep rather than compute, and share nothing with the timer while it does.",
    example=in_run(Symptom.STANDS_STILL, pace="slow", stops=False),
)
def slowed(case: Case) -> Iterator[Found]:
    """A timer loses ticks while other work goes on.

    Python runs one thread at a time. Work that computes without a pause, or threads that take turns with the timer's,
    leave it fewer chances to run than it needs.

    Bad:

        while time.monotonic() < end:
            pass

    Good:

        time.sleep(3.0)

    See it: `ros2 topic hz TOPIC`, or the numbers in the log, during a call.
    """
    if case.about("pace") == "slow":
        yield Found()


@mistake(
    "timer-pauses",
    explains=[Symptom.STANDS_STILL],
    evidence=Evidence.SYMPTOM,
    says="the timer goes on during a call, but pauses for {pause_s:.1f} s of it",
    do="Let the two callbacks share no lock, and neither of them wait for the other.",
    example=in_run(Symptom.STANDS_STILL, pace="pauses", pause_s=1.2, stops=False),
)
def pauses(case: Case) -> Iterator[Found]:
    """A timer pauses for part of a call.

    Two callbacks that may run side by side still wait for each other if they share a lock, or if one waits for what the
    other does.

    Bad:

        with self.lock:
            time.sleep(1.0)

    Good:

        time.sleep(1.0)
        with self.lock:
            self.opened += 1

    See it: the time stamps of the log during a call.
    """
    if case.about("pace") == "pauses":
        yield Found({"pause_s": case.about("pause_s")})
