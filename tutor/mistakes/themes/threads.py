"""The threads of an executor: how many callbacks may be busy at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.callback_groups import in_worker, one_at_a_time, stops
from tutor.source.callback_groups import MULTI_THREADED, threads_of

_STILL = (Symptom.STANDS_STILL,)


def _in_spin(source: str) -> Sequence[Frame]:
    return (
        Frame("/ws/node.py", 1, "open_the_door", source.splitlines()[0], 1),
        Frame("/lib/rclpy/executors.py", 1, "spin", "", 1),
    )


@mistake(
    "one-thread-for-all-callbacks",
    explains=_STILL,
    evidence=Evidence.RUN,
    says="one thread runs all callbacks, so everything else waits while the service works{where}",
    do="Let a MultiThreadedExecutor with several threads spin the node.",
    example=in_run(Symptom.STANDS_STILL, stuck_at=_in_spin),
)
def one_thread(case: Case) -> Iterator[Found]:
    """One thread runs all callbacks.

    rclpy.spin() and a SingleThreadedExecutor run one callback after another. While one takes three seconds, the node's
    timers, subscriptions and other services wait for it, whatever their callback groups are.

    Bad:

        rclpy.spin(door)

    Good:

        executor = MultiThreadedExecutor(num_threads=4)
        executor.add_node(door)
        executor.spin()

    See it: the time stamps of the log during a slow call.

    Lesson: i2.3, on executors.
    """
    stuck = case.stuck
    if one_at_a_time(case):
        if not case.program.calls(MULTI_THREADED) and case.program.calls("spin"):
            yield Found({"where": ""})
    elif stuck and stops(case) and not in_worker(stuck):
        own = tracebacks.own_frame(stuck, case.trace.folder)
        where = f" (line {own.line} of {own.name})" if own is not None else ""
        yield Found({"where": where}, own.name if own else "", own.line if own else 0, own.code if own else "")


@mistake(
    "too-few-threads",
    explains=_STILL,
    says="{line} gives the executor {threads}, and {what}: {code}",
    do="Give the executor more threads than callbacks that may be busy at once.",
    example=in_run(Symptom.STANDS_STILL, ratio=2.0),
)
def too_few_threads(case: Case) -> Iterator[Found]:
    """A MultiThreadedExecutor has too few threads.

    Each busy callback takes up a thread. Without num_threads, the executor has as many threads as the machine has
    cores: two cores serve two calls at once, and a third call waits.

    Bad:

        executor = MultiThreadedExecutor(num_threads=1)

    Good:

        executor = MultiThreadedExecutor(num_threads=8)

    See it: call the service several times at once, and look at the times in the log.
    """
    for file in case.files:
        made, number = threads_of(file)
        if made is None:
            continue
        if one_at_a_time(case):
            ratio, reentrant = case.about("ratio"), bool(file.calls("ReentrantCallbackGroup"))
            if (number is None or number < 4) and (reentrant or ratio < 2.5):
                threads = f"{number} threads" if number else "as many threads as this machine has cores"
                if number == 1:
                    threads = "one thread"
                yield found(file, made, threads=threads, what=f"the calls took {ratio:.1f} times as long as one")
        elif number == 1 and stops(case):
            yield found(file, made, threads="one thread", what="the service takes it for as long as it works")
