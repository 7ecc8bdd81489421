"""Timers: how many there are, which of them run, and what becomes of an old one."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise, takewhile

from tutor.judge.rates import Rate
from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import NodeFile, argument, calls_in, values_of
from tutor.source.concurrency import are_of_one_node

_TOO_MANY = (Symptom.WRONG_RATE, Symptom.BAD_VALUE_ACCEPTED)
_TOO_FEW = (Symptom.NO_MESSAGES, Symptom.WRONG_RATE, Symptom.STANDS_STILL, Symptom.CHANGE_IGNORED)


@mistake(
    "timer-for-each-call",
    explains=[Symptom.STANDS_STILL],
    says="{line} makes one more timer in each call, and all of them tick from then on: {code}",
    do="Make the timer once, where the node is set up.",
)
def timer_for_each_call(case: Case) -> Iterator[Found]:
    """A service's callback makes a timer that nothing ends.

    A timer runs until it is cancelled. One that is made anew in each call adds its ticks to those of all before it.

    Bad:

        def __init__(self):
            self.create_service(Trigger, 'ring', self.ring)

        def ring(self, request, response):
            self.create_timer(1.0, self.blink)
            return response

    Good:

        def __init__(self):
            self.create_service(Trigger, 'ring', self.ring)
            self.create_timer(1.0, self.blink)

        def ring(self, request, response):
            return response

    See it: the time stamps of the log, after one call and after two.
    """
    for file in case.files:
        inside = file.callbacks("create_service")
        if not any(file.function_around(call) in inside for call in file.calls("cancel", "destroy_timer", "destroy")):
            yield from (found(file, timer) for timer in file.timers if file.function_around(timer) in inside)


@mistake(
    "two-timers",
    explains=(*_TOO_MANY, Symptom.STANDS_STILL),
    says="{line} makes a timer, and line {other} another with the same callback, so both call it",
    do="Keep one of the two timers.",
)
def two_timers(case: Case) -> Iterator[Found]:
    """Two timers call one callback.

    Each create_timer makes a timer that runs from then on. A second one with the same callback doubles the rate, or
    mixes a fixed rate with the one that was asked for; a tutorial's timer is easily left behind.

    Bad:

        def __init__(self):
            self.create_timer(0.5, self.blink)
            self.create_timer(1.0 / self.rate, self.blink)

    Good:

        def __init__(self):
            self.create_timer(1.0 / self.rate, self.blink)

    See it: `ros2 topic hz TOPIC`: more than asked for, and uneven.
    """
    for file in case.files:
        at_start = file.reachable_from(file.setup) if file.setup is not None else []
        at_start += file.functions_named("__init__")
        made = [call for call in file.timers if file.function_around(call) in at_start]
        for call, other in pairwise(made):
            if are_of_one_node(file, call, other) and all(
                _same(argument(call, name), argument(other, name)) for name in ("timer_period_sec", "callback")
            ):
                yield found(file, call, other=other.lineno)
        fixed = [call for call in made if _is_fixed(file, argument(call, "timer_period_sec"))]
        for call in fixed:
            for other in made:
                same = _same(argument(call, "callback"), argument(other, "callback"))
                if other not in fixed and same and are_of_one_node(file, call, other):
                    yield found(file, call, other=other.lineno)


@mistake(
    "several-timers",
    explains=_TOO_MANY,
    says="the loop in line {loop} makes a timer in each round, and each of them calls the callback at the full rate",
    do="Make one timer, outside the loop.",
)
def several_timers(case: Case) -> Iterator[Found]:
    """A loop makes several timers.

    A timer for each room, sensor or name calls its callback at the full rate. One timer whose callback goes through
    them all keeps the rate that was asked for.

    Bad:

        def __init__(self):
            for room in self.rooms:
                self.create_timer(1.0, self.blink)

    Good:

        def __init__(self):
            self.create_timer(1.0, self.blink)

    See it: `ros2 topic hz TOPIC` gives a multiple of the rate.
    """
    for file in case.files:
        if (timer := file.first_timer) is None:
            continue
        function = file.function_around(timer)
        within = takewhile(lambda around, end=function: around is not end, file.ancestors(timer))  # type: ignore[misc]
        for loop in within:
            if isinstance(loop, ast.If):  # in one of the rounds, such as that of the rate among parameters
                break
            if isinstance(loop, ast.For):
                yield found(file, timer, loop=loop.lineno)


@mistake(
    "messages-in-bursts",
    explains=[Symptom.WRONG_RATE],
    evidence=Evidence.SYMPTOM,
    says="several messages are sent at once, then none for a while",
    do="Send one message in each call of the timer's callback, and leave the pace to the timer.",
    example=in_run(Symptom.WRONG_RATE, rate=Rate(5.0, 10, 1.8, 0.001)),
)
def bursts(case: Case) -> Iterator[Found]:
    """Messages are sent in bursts.

    A rate of 5 Hz means a message every 0.2 seconds, not five at the beginning of each second. Bursts overflow short
    queues, and whoever listens sees nothing in between.

    Bad:

        def blink(self):
            for _ in range(5):
                self.lamp.publish(Bool(data=True))

    Good:

        def blink(self):
            self.lamp.publish(Bool(data=True))

    See it: `ros2 topic hz TOPIC`: the smallest gap is close to zero.
    """
    rate = case.about("rate")
    if rate is not None and rate.in_bursts:
        yield Found()


@mistake(
    "timer-not-started",
    explains=(*_TOO_FEW, Symptom.NOT_LOGGED),
    says="{line} makes a timer that does not start on its own (autostart is False), and nothing starts it",
    do="Let the timer start on its own, or call its reset() when it should begin.",
)
def timer_not_started(case: Case) -> Iterator[Found]:
    """A timer is made with autostart=False, and nothing starts it.

    Such a timer waits until its reset() is called. That is meant for timers that are made early and needed later.

    Bad:

        self.lamp = self.create_timer(0.5, self.blink, autostart=False)

    Good:

        self.lamp = self.create_timer(0.5, self.blink, autostart=False)
        self.lamp.reset()

    See it: the callback never logs anything.
    """
    for file in case.files:
        resets = {ast.unparse(call.func) for call in file.calls("reset")}
        for call in file.timers:
            match argument(call, "autostart"):
                case ast.Constant(value=False) if f"{file.assigned_to(call)}.reset" not in resets:
                    yield found(file, call)


@mistake(
    "timer-cancelled",
    explains=(*_TOO_FEW, Symptom.NOT_LOGGED),
    says="{line} ends the timer, in {function}: {code}",
    do="Let the timer run for as long as the node does.",
)
def self_cancelling(case: Case) -> Iterator[Found]:
    """A callback ends a timer.

    cancel() stops a timer until its reset() is called, and destroy_timer() stops it for good. In its own callback, they
    make a timer that fires once, or a few times; in another one, it fires no more once that was called.

    Bad:

        def __init__(self):
            self.lamp = self.create_timer(0.5, self.blink)

        def blink(self):
            self.lamp.cancel()

    Good:

        def __init__(self):
            self.lamp = self.create_timer(0.5, self.blink)

        def blink(self):
            self.switch()

    See it: `ros2 topic echo TOPIC` stops after a few messages.
    """
    for file in case.files:
        for timer in file.timers:
            callback, name = file.function(argument(timer, "callback")), file.assigned_to(timer)
            reached = list(file.reachable_from(callback)) if callback is not None and name else []
            if case.symptom is Symptom.STANDS_STILL and name:
                served = file.callbacks("create_service")
                reached += [function for function in served if not calls_in(function, "reset", "create_timer")]
            for call in file.calls("cancel", "destroy_timer"):
                owner = [call.func.value] if isinstance(call.func, ast.Attribute) else []
                function = file.function_around(call)
                if function in reached and name in map(ast.unparse, (*call.args, *owner)):
                    yield found(file, call, function=function.name)


def _is_fixed(file: NodeFile, period: ast.expr | None) -> bool:
    if isinstance(period, ast.BinOp):
        return _is_fixed(file, period.left) and _is_fixed(file, period.right)
    if period is None or isinstance(period, ast.Constant):
        return period is not None
    values = values_of(ast.unparse(period), file.tree)
    return bool(values) and all(isinstance(value, ast.Constant) for value in values)


def _same(one: ast.expr | None, other: ast.expr | None) -> bool:
    return one is not None and other is not None and ast.unparse(one) == ast.unparse(other)
