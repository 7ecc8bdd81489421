"""I1.2: mistakes in the rate that a summary states."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from checks.i1_2_message_statistics.mistakes.entries import CATALOGUE, shown, told
from checks.i1_2_message_statistics.mistakes.wrong_rates import find_wrong_rate
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Found, found
from tutor.mistakes.examples import in_run
from tutor.source import last_name


def _told(case: Case, fault: str) -> Iterator[Found]:
    """What is wrong with the rate in a summary, if it is this fault."""
    if case.about("fault") != "wrong-rate":
        yield from told(case, fault)
    elif (wrong := find_wrong_rate(case.about("summary"), case.about("summaries")))["fault"] == fault:
        yield Found(wrong)


@CATALOGUE.mistake(
    "worked-out-once",
    explains=[Symptom.WRONG_LOG],
    says="{line} keeps {rate}, the first result, forever: {code}",
    do="Work it out anew for each summary.",
    example=in_run(Symptom.WRONG_LOG, fault="rate-never-updated", rate="7.85"),
)
def worked_out_once(case: Case) -> Iterator[Found]:
    """A value that should change is kept.

    functools.cache and cached_property remember the first result; so does an attribute that is set only while it is
    None. That is right for what never changes.

    Bad:

        @cached_property
        def speed(self):
            return self.metres / self.seconds

    Good:

        @property
        def speed(self):
            return self.metres / self.seconds

    See it: the log, when the value should change.
    """
    for file in case.files if case.about("fault") == "rate-never-updated" else ():
        for function in file.functions:
            for decorator in function.decorator_list:
                name = last_name(decorator.func if isinstance(decorator, ast.Call) else decorator)
                if name in ("cached_property", "cache", "lru_cache"):
                    yield found(file, decorator, rate=case.about("rate"))
        for node in file.nodes:
            match node:
                case ast.If(
                    test=ast.Compare(left=kept, ops=[ast.Is()]) | ast.UnaryOp(op=ast.Not(), operand=kept),
                    body=[ast.Assign(targets=[target], value=value)],
                    orelse=[],
                ) if ast.unparse(kept) == ast.unparse(target) and _divides(value):
                    yield found(file, node, rate=case.about("rate"))


def _divides(value: ast.expr) -> bool:
    return any(isinstance(node, ast.Div) for node in ast.walk(value))


@shown(
    "rate-never-updated",
    says="it still says {rate} when the messages come at another rate",
    do="Find where the rate is worked out, and make sure that this happens for each summary.",
    rate="7.85",
)
def never_updated(case: Case) -> Iterator[Found]:
    """A rate is worked out once, and kept.

    A rate changes with what is measured. What is computed at the start, or for the first summary only, stays as it was.

    Bad:

        if self.visitors == 100:
            self.per_hour = self.visitors / self.hours()

    Good:

        if self.visitors % 100 == 0:
            self.per_hour = self.visitors / self.hours()

    See it: the log, beside `ros2 topic hz TOPIC`, at two rates.
    """
    return told(case, "rate-never-updated")


@shown(
    "period-instead-of-a-rate",
    says="{number} is the time from one message to the next, in seconds",
    do="Turn the division round: a rate is messages per second.",
    number="0.20",
)
def period(case: Case) -> Iterator[Found]:
    """A period is given as a rate.

    A period is seconds per message, a rate messages per second: one is 1 divided by the other.

    Bad:

        rate = seconds / rings

    Good:

        rate = rings / seconds

    See it: `ros2 topic hz TOPIC` gives both.
    """
    return _told(case, "period-instead-of-a-rate")


@shown(
    "rate-per-minute",
    says="{number} is messages per minute",
    do="See which unit the time has that you divide by: it should be seconds.",
    number="297.00",
)
def per_minute(case: Case) -> Iterator[Found]:
    """A rate is given per minute, not per second.

    The unit of a rate depends on that of the time you divide by.

    Bad:

        minutes = seconds / 60
        rate = rings / minutes

    Good:

        rate = rings / seconds

    See it: the log, beside `ros2 topic hz TOPIC`.
    """
    return _told(case, "rate-per-minute")


@shown(
    "rate-in-another-unit",
    says="{number} is off by a factor of a thousand, or a power of it",
    do="See which unit the clock counts in, and convert its time to seconds before you divide.",
    number="0.00495",
)
def other_unit(case: Case) -> Iterator[Found]:
    """A time is in milliseconds or nanoseconds.

    rclpy's Time and Duration, and time.time_ns(), count nanoseconds: a second is 10**9 of them. time.time() counts
    seconds.

    Bad:

        seconds = (now - then).nanoseconds

    Good:

        seconds = (now - then).nanoseconds / 1e9

    See it: the log, beside `ros2 topic hz TOPIC`.
    """
    return _told(case, "rate-in-another-unit")


@shown(
    "counted-from-the-nodes-start",
    name="counted from the node's start",
    says="{number} is right if the clock starts {lead_s:.1f} s before the first message",
    do="Let the time start with the first message, not with the node.",
    number="2.91",
    lead_s=1.2,
)
def from_start(case: Case) -> Iterator[Found]:
    """A clock starts when the node does.

    A subscriber may wait a while for its first message. If that wait counts, the rate is too low at first.

    Bad:

        def __init__(self):
            self.since = time.monotonic()

    Good:

        def on_ring(self, message):
            if self.since is None:
                self.since = time.monotonic()

    See it: start the subscriber a while before the publisher.
    """
    return _told(case, "counted-from-the-nodes-start")


@shown(
    "seconds-cut-off",
    says="{number} is {covered} messages in {whole_s} s, but it took longer",
    do="Keep the fractions of the seconds: no int(), no //, and no field that holds whole seconds only.",
    number="10.00",
    covered=10,
    whole_s=1,
)
def cut_seconds(case: Case) -> Iterator[Found]:
    """The fractions of a time are cut off.

    int() and // drop what comes after the decimal point, and the field sec of a Time message holds whole seconds only.
    Of 1.8 s, 1 s is left.

    Bad:

        seconds = int(time.monotonic() - self.since)

    Good:

        seconds = time.monotonic() - self.since

    See it: log the time that you divide by.
    """
    return _told(case, "seconds-cut-off")


@shown(
    "no-rate",
    says="it contains no number other than the count",
    do="Put the messages per second into the summary.",
)
def no_rate(case: Case) -> Iterator[Found]:
    """There is no rate.

    A rate is a number of messages, divided by the seconds in which they came.

    Bad:

        self.get_logger().info(f'{self.rings} rings')

    Good:

        self.get_logger().info(f'{self.rings} rings, {self.rings / self.seconds()} per second')

    See it: the log.
    """
    return _told(case, "no-rate")


@shown(
    "wrong-rate-in-the-summary",
    name="wrong rate",
    says="{what}",
    do="Log the two numbers that you divide: the messages, and the seconds in which exactly these came.",
    what="none of 1.00 is the rate",
)
def wrong_rate(case: Case) -> Iterator[Found]:
    """A stated rate is not the rate of the messages.

    The messages and the seconds of a rate belong together: all since the first message, or those of the same window.

    Bad:

        rate = self.rings_in_all / self.seconds_since_the_last_ring

    Good:

        rate = self.rings_in_all / self.seconds_since_the_first_ring

    See it: the log, beside `ros2 topic hz TOPIC`.
    """
    return _told(case, "wrong-rate-in-the-summary")
