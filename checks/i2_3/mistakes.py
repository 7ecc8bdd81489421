"""I2.3: the mistakes that only this exercise can know."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import CallAnswer
from tutor.mistakes import Case, Catalogue, Evidence, Found, found
from tutor.mistakes.examples import in_run
from tutor.source import calls_in, last_name

CATALOGUE = Catalogue()

_SHORT, _LONG = 1.0, 5.0


@CATALOGUE.mistake(
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


@CATALOGUE.mistake(
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


@CATALOGUE.mistake(
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


@CATALOGUE.mistake(
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


@CATALOGUE.mistake(
    "wrong-duration",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.SYMPTOM,
    says="the answer comes after {took_s:.1f} s, not after {wanted_s:g} s{where}",
    do="Look at how long the callback works before it answers, and in which unit that is.",
    example=in_run(Symptom.WRONG_ANSWER, took_s=_SHORT, wanted_s=_LONG),
)
def wrong_duration(case: Case) -> Iterator[Found]:
    """A callback takes longer, or less long, than it should.

    time.sleep() takes seconds. The wait() of an Event that is already set returns at once; a loop of short sleeps takes
    a little longer than their sum.

    Bad:

        time.sleep(500)

    Good:

        time.sleep(0.5)

    See it: `time ros2 service call …`.
    """
    if case.about("took_s") is None:
        return
    words = {"took_s": case.about("took_s"), "wanted_s": case.about("wanted_s")}
    waits = [
        (file, call)
        for file in case.files
        for function in file.callbacks("create_service")
        for call in calls_in(function, "sleep", "wait")
    ]
    if len(waits) == 1:
        file, call = waits[0]
        yield found(file, call, where=f"; {case.place(file.name, call.lineno)}: {file.line(call.lineno)}", **words)
    yield Found({**words, "where": ""})


@CATALOGUE.mistake(
    "wrong-sum",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.SYMPTOM,
    says="{seen}; see {line}: {code}",
    do="{step}",
    example=in_run(
        Symptom.WRONG_ANSWER,
        answer=CallAnswer("/count", {"a": 2, "b": 5}, {"sum": 10}, 0.0, 0.1),
        wanted=7,
        says="10 instead of 7",
        do="Count again.",
    ),
)
def wrong_sum(case: Case) -> Iterator[Found]:
    """What a callback puts into the response is wrong.

    A response holds what the callback puts into its fields. The request's fields are whole numbers of 64 bits, and
    Python's own integers are as long as they need to be: neither a float nor a narrower type is needed in between.

    Bad:

        response.sum = 10

    Good:

        response.sum = request.a + request.b

    See it: `ros2 service call`, with small numbers and with large ones.
    """
    answer = case.about("answer")
    if answer is None or not answer.response or answer.response.get("sum") in (0, None):
        return
    places = [
        (file, node)
        for file in case.files
        for node in file.nodes
        if isinstance(node, ast.Assign) and any(last_name(target) == "sum" for target in node.targets)
    ]
    if len(places) == 1:
        yield found(*places[0], seen=case.seen.says, step=case.seen.do)
