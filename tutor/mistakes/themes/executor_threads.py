"""Threads: how many callbacks an executor can have at work, and what its threads wait for."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.callback_groups import in_worker, one_at_a_time, stops
from tutor.source import NodeFile, argument, calls_in
from tutor.source.concurrency import MULTI_THREADED, group_of, is_reentrant, threads_of

_STILL = (Symptom.STANDS_STILL, Symptom.CALLS_WAIT)
_ONE_THREADED = ("SingleThreadedExecutor", "EventsExecutor")
_LOCKS = ("Lock", "RLock", "Condition")
_WAITS = ("sleep", "sleep_for", "wait", "join")


def _in_spin(source: str) -> Sequence[Frame]:
    return (
        Frame("/ws/node.py", 1, "open_the_door", source.splitlines()[0], 1),
        Frame("/lib/rclpy/executors.py", 1, "spin", "", 1),
    )


@mistake(
    "one-thread-for-all-callbacks",
    explains=_STILL,
    evidence=Evidence.RUN,
    says="{spins}, so while one of them works{where}, all others wait{at}",
    do="{step}",
    example=in_run(Symptom.STANDS_STILL, stuck_at=_in_spin),
)
def one_thread(case: Case) -> Iterator[Found]:
    """One thread runs all callbacks.

    rclpy.spin() and a SingleThreadedExecutor run one callback after another. While one takes three seconds, the node's
    timers, subscriptions and other services wait for it, whatever their callback groups are. rclpy.spin(node) also
    takes the node out of any other executor.

    Bad:

        rclpy.spin(door)

    Good:

        executor = MultiThreadedExecutor(num_threads=4)
        executor.add_node(door)
        executor.spin()

    See it: the time stamps of the log during a slow call.

    Lesson: i2.3, on executors.
    """
    spins = [(file, call) for file in case.files for call in _spins_in_one_thread(file)]
    several = bool(case.program.calls(MULTI_THREADED))
    where = ""
    if case.symptom is Symptom.CALLS_WAIT:
        added = {ast.unparse(node) for call in case.program.calls("add_node") for node in call.args}
        taken = [(file, call) for file, call in spins if call.args and ast.unparse(call.args[0]) in added]
        spins = taken if several else spins
        if not one_at_a_time(case) or not spins:
            return
    elif not stops(case) or in_worker(case.stuck) or (not case.stuck and (several or not spins)) or _only_awaits(case):
        return
    elif (own := tracebacks.own_frame(case.stuck, case.trace.folder)) is not None:
        where = f" ({case.place(own.name, own.line)})"
    step = "Let a MultiThreadedExecutor with several threads spin the node."
    if several:
        step = "Let nothing but the MultiThreadedExecutor spin the node, and give it several threads."
    if spins:
        file, call = spins[0]
        spins_there = f"{case.place(file.name, call.lineno)} runs the callbacks in one thread"
        yield found(file, call, spins=spins_there, where=where, at=f": {file.line(call.lineno)}", step=step)
    else:
        yield Found({"spins": "one thread runs all callbacks", "where": where, "at": "", "step": step})


def _only_awaits(case: Case) -> bool:
    """Whether no thread is in a callback, by the stack dump, while an async one of the program has not ended."""
    threads = tracebacks.frames_by_thread(case.stuck)
    free = bool(threads) and not any(tracebacks.called_by_executor(thread, case.trace.folder) for thread in threads)
    return free and any(isinstance(node, ast.Await) for node in case.program.nodes())


def _spins_in_one_thread(file: NodeFile) -> Iterator[ast.Call]:
    """The calls that spin the global executor, or one that has a single thread."""
    single = {file.assigned_to(call) for call in file.calls(*_ONE_THREADED)} - {""}
    for call in file.calls("spin"):
        match call.func:
            case ast.Name() | ast.Attribute(value=ast.Name("rclpy")):
                if argument(call, "executor") is None:
                    yield call
            case ast.Attribute(value=executor) if ast.unparse(executor) in single:
                yield call


@mistake(
    "too-few-threads",
    explains=_STILL,
    says="{line} gives the executor {threads}, and {what}: {code}",
    do="Give the executor more threads than callbacks that may be busy at once.",
    example=in_run(Symptom.CALLS_WAIT, ratio=2.0),
)
def too_few_threads(case: Case) -> Iterator[Found]:
    """A MultiThreadedExecutor has too few threads.

    Each busy callback takes up a thread. Without num_threads, the executor has as many threads as the machine has
    cores: two cores serve two calls at once, and a third call waits.

    Bad:

        executor = MultiThreadedExecutor(num_threads=2)

    Good:

        executor = MultiThreadedExecutor(num_threads=8)

    See it: call the service several times at once, and look at the times in the log.
    """
    for file in case.files:
        made, number = threads_of(file)
        if made is None or number is None:
            continue
        if number == 1 and (stops(case) or one_at_a_time(case)):
            yield found(file, made, threads="one thread", what="all other callbacks wait while one of them works")
        elif number < 3 and case.symptom is Symptom.CALLS_WAIT and _may_overlap(file, case):
            threads = f"{number} threads" if number else "as many threads as this machine has cores"
            yield found(file, made, threads=threads, what="each call that is worked on needs one")


def _may_overlap(file: NodeFile, case: Case) -> bool:
    """Whether calls do overlap, or would if there were threads for them."""
    services = [] if file.calls(*_LOCKS) else file.calls("create_service")
    reentrant = bool(services) and all(is_reentrant(file, group_of(service)) for service in services)
    return reentrant or not one_at_a_time(case)


@mistake(
    "lock-held-while-waiting",
    explains=[Symptom.CALLS_WAIT],
    says="{line} takes {lock} for as long as a call works, so the next call waits for it: {code}",
    do="Hold the lock only while shared data changes, and do the waiting outside it.",
)
def lock_held(case: Case) -> Iterator[Found]:
    """A callback holds a lock while it waits.

    A lock lets one thread in at a time. A callback that sleeps while it holds one keeps out all other callbacks that
    take the lock, and other calls of its own service, however many threads there are.

    Bad:

        def __init__(self):
            self.create_service(Trigger, 'open_door', self.open_the_door)

        def open_the_door(self, request, response):
            with self.lock:
                time.sleep(3.0)
                self.opened += 1
            return response

    Good:

        def __init__(self):
            self.create_service(Trigger, 'open_door', self.open_the_door)

        def open_the_door(self, request, response):
            time.sleep(3.0)
            with self.lock:
                self.opened += 1
            return response

    See it: call the service twice at once, and look at the times in the log.
    """
    for file in case.files if one_at_a_time(case) else ():
        for function in file.callbacks("create_service"):
            for block in ast.walk(function):
                if isinstance(block, ast.With) and any(calls_in(statement, *_WAITS) for statement in block.body):
                    lock = ast.unparse(block.items[0].context_expr)
                    if re.search("lock|mutex|semaphore", lock, re.IGNORECASE):
                        yield found(file, block, lock=lock)
