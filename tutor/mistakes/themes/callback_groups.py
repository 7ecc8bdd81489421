"""Callback groups: what makes one callback wait for another one that takes its time."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import Function, NodeFile, argument
from tutor.source.concurrency import (
    GROUPS,
    group_of,
    is_exclusive,
    is_set_after,
    names_of,
    timers_sharing_group,
)

ONE_BY_ONE = 2.6
"""Three calls that take at least this many times as long as one were served one after the other."""


def in_worker(stuck: Sequence[Frame]) -> bool:
    """Whether a stack dump shows the threads of a MultiThreadedExecutor at work."""
    return any(frame.path.endswith("concurrent/futures/thread.py") for frame in stuck)


def _in_pool(source: str) -> Sequence[Frame]:
    return (
        Frame("/ws/node.py", 1, "open_the_door", source.splitlines()[0], 1),
        Frame("/lib/python3.12/concurrent/futures/thread.py", 1, "run", "", 1),
    )


def stops(case: Case) -> bool:
    """Whether everything else stops while one callback runs, and does not only pause or come in a burst."""
    return case.symptom is Symptom.STANDS_STILL and bool(case.about("stops", True))


def one_at_a_time(case: Case) -> bool:
    """Whether calls made at once were served one after the other, and not some of them beside others.

    `ratio`: how many times as long as one call they took.
    """
    return case.symptom is Symptom.CALLS_WAIT and case.about("ratio", ONE_BY_ONE) >= ONE_BY_ONE


def _services(file: NodeFile) -> list[ast.Call]:
    return file.calls("create_service")


@mistake(
    "callback-group-set-too-late",
    explains=(Symptom.STANDS_STILL, Symptom.CALLS_WAIT),
    says="{line} is made before line {later} sets its callback group, which is still None then: {code}",
    do="Make the groups before super().__init__() uses them, or set everything up after it.",
    example=in_run(Symptom.STANDS_STILL),
)
def set_too_late(case: Case) -> Iterator[Found]:
    """A callback group is set after it was used.

    A base class whose constructor makes timers and services uses the groups that exist at that moment. None stands for
    the node's default group, which is mutually exclusive: everything in it waits for everything else.

    Bad:

        class Door(Base):
            def __init__(self):
                super().__init__()
                self.group = ReentrantCallbackGroup()

            def set_up(self):
                self.create_timer(1.0, self.blink, callback_group=self.group)

    Good:

        class Door(Base):
            def __init__(self):
                super().__init__()
                self.group = ReentrantCallbackGroup()
                self.set_up()

            def set_up(self):
                self.create_timer(1.0, self.blink, callback_group=self.group)

    See it: log the group where the timer is made.
    """
    for file in case.files if stops(case) or one_at_a_time(case) else ():
        for made in file.timers if stops(case) else _services(file):
            group, creator = group_of(made), file.function_around(made)
            groups = [call for call in file.calls(*GROUPS) if group and file.assigned_to(call) == group]
            if len(groups) == 1 and creator is not None and is_set_after(file, groups[0], creator):
                yield found(file, made, later=groups[0].lineno)


@mistake(
    "same-callback-group",
    explains=[Symptom.STANDS_STILL],
    says="{line} {puts}, beside the service, and that group runs one callback at a time: {code}",
    do="Give the timer and the service different callback groups, or a reentrant one.",
    example=in_run(Symptom.STANDS_STILL),
)
def same_group(case: Case) -> Iterator[Found]:
    """Two callbacks are in one mutually exclusive group.

    Callbacks of one MutuallyExclusiveCallbackGroup never run at the same time, however many threads there are. Without
    callback_group, everything is in the node's default group, which is one of these.

    Bad:

        self.create_service(Trigger, 'open_door', self.open_the_door)
        self.create_timer(1.0, self.blink)

    Good:

        self.create_service(Trigger, 'open_door', self.open_the_door)
        self.create_timer(1.0, self.blink, callback_group=MutuallyExclusiveCallbackGroup())

    See it: the log stands still while the service works.

    Lesson: i2.3, on callback groups.
    """
    for file in case.files if stops(case) else ():
        for service in _services(file):
            for timer in timers_sharing_group(file, service):
                group = group_of(timer)
                puts = f"puts the timer into {group}" if group else "leaves the timer in the node's default group"
                yield found(file, timer, puts=puts)


@mistake(
    "one-call-at-a-time",
    explains=[Symptom.CALLS_WAIT],
    says="{line} {puts}, where each call waits for the one before: {code}",
    do="Put the service into a group that lets its callback run several times at once.",
)
def one_call_at_a_time(case: Case) -> Iterator[Found]:
    """The calls of one service wait for each other.

    A service's callback can run several times at once only in a ReentrantCallbackGroup. In the node's default group, or
    in another mutually exclusive one, each call waits until the one before it has been answered.

    Bad:

        self.create_service(Trigger, 'open_door', self.open_the_door)

    Good:

        self.create_service(Trigger, 'open_door', self.open_the_door, callback_group=ReentrantCallbackGroup())

    See it: start two `ros2 service call` at once, and look at the times in the log.
    """
    if one_at_a_time(case):
        for file in case.files:
            for service in _services(file):
                group = group_of(service)
                if is_exclusive(file, group):
                    puts = "puts the service into a mutually exclusive group"
                    yield found(file, service, puts=puts if group else "leaves the service in the node's default group")


@mistake(
    "callback-group-not-used",
    explains=(Symptom.WRONG_RATE, Symptom.STANDS_STILL, Symptom.CALLS_WAIT),
    says="{line} makes a callback group, but no callback is in it: {code}",
    do="Name the group where the timers and services are made.",
    example=in_run(Symptom.WRONG_RATE),
)
def unused_group(case: Case) -> Iterator[Found]:
    """A callback group is made, but nothing is in it.

    A group matters only for the callbacks that are made with callback_group=…; all others are in the node's default
    group, where each waits for the others.

    Bad:

        self.group = ReentrantCallbackGroup()
        self.create_timer(1.0, self.blink)
        self.create_timer(0.1, self.look)
        executor = MultiThreadedExecutor()

    Good:

        self.group = ReentrantCallbackGroup()
        self.create_timer(1.0, self.blink, callback_group=self.group)
        self.create_timer(0.1, self.look, callback_group=self.group)
        executor = MultiThreadedExecutor()

    See it: the callbacks never overlap in the log.
    """
    for file in case.files:
        for made in file.calls(*GROUPS):
            name = file.assigned_to(made)
            if name.startswith("self.") and len(re.findall(rf"\b{re.escape(name[5:])}\b", file.text)) == 1:
                yield found(file, made)


@mistake(
    "timer-waits-for-the-service",
    explains=[Symptom.STANDS_STILL],
    evidence=Evidence.SYMPTOM,
    says="the timer stops while the service works{where}, although a MultiThreadedExecutor runs the callbacks",
    do="Compare the callback groups of the two, look for a lock that both take, and count the executor's threads.",
    example=in_run(Symptom.STANDS_STILL, stuck_at=_in_pool),
)
def waits_in_worker(case: Case) -> Iterator[Found]:
    """A timer waits for a service despite several threads.

    Threads help only callbacks in different groups, or in a reentrant one. A lock that both take also makes one wait
    for the other, and so does a computation that keeps Python's own lock.

    Bad:

        def open_the_door(self, request, response):
            with self.lock:
                time.sleep(3.0)

    Good:

        def open_the_door(self, request, response):
            time.sleep(3.0)
            with self.lock:
                self.opened += 1

    See it: the log stands still while the service works.
    """
    if case.stuck and in_worker(case.stuck) and stops(case):
        own = tracebacks.own_frame(case.stuck, case.trace.folder)
        where = f" ({case.place(own.name, own.line)})" if own is not None else ""
        yield Found({"where": where}, own.name if own else "", own.line if own else 0, own.code if own else "")


@mistake(
    "deadlock-by-await",
    explains=(Symptom.NO_ANSWER, Symptom.WRONG_ANSWER, Symptom.CALLS_MISSING),
    says="{line} awaits something that arrives in its own callback group, which this callback keeps busy: {code}",
    do="Put the client into a callback group of its own, or a reentrant one.",
)
def deadlock_by_await(case: Case) -> Iterator[Found]:
    """A callback awaits an answer in its own callback group.

    await frees the executor, but not the callback's group: in a mutually exclusive group (the default), nothing else in
    that group runs before this callback has ended, and a client's answer is handled in the client's group.

    Bad:

        def __init__(self):
            self.door = self.create_client(Trigger, 'open_door')
            self.create_service(Trigger, 'ring', self.on_bell)

        async def on_bell(self, request, response):
            await self.door.call_async(Trigger.Request())
            return response

    Good:

        def __init__(self):
            self.door = self.create_client(Trigger, 'open_door', callback_group=ReentrantCallbackGroup())
            self.create_service(Trigger, 'ring', self.on_bell)

        async def on_bell(self, request, response):
            await self.door.call_async(Trigger.Request())
            return response

    See it: the service that is called logs the call, and the caller never goes on.
    """
    for file in case.files:
        clients = [group_of(client) for client in file.calls("create_client")]
        if not clients and file.calls("ReentrantCallbackGroup"):
            continue
        for creator in ("create_timer", "create_subscription", "create_service"):
            for made in file.calls(creator):
                group = group_of(made)
                if not is_exclusive(file, group) or group.endswith(")"):  # a call makes another group each time
                    continue
                if clients and not any(client in names_of(file, group) for client in clients):
                    continue
                for function in file.reachable_from(callback) if (callback := _callback(file, made)) else ():
                    for node in ast.walk(function):
                        if isinstance(node, ast.Await):
                            yield found(file, node)


def _callback(file: NodeFile, made: ast.Call) -> Function | None:
    return file.function(argument(made, "callback"))
