"""A timer's period: its unit, its decimals, and the number that it is made of."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.spinning import untimed_spin_once
from tutor.source import NodeFile, argument, last_name, match, values_of

_RATES = (Symptom.WRONG_RATE, Symptom.NO_MESSAGES, Symptom.CHANGE_IGNORED)
_NO_SUCH_ATTRIBUTES = (
    "period", "timer_period", "timer_period_sec", "timer_period_s", "interval", "period_sec", "rate",
)  # fmt: skip

MIN_MILLISECONDS = 50.0
"""A timer's period from this number on is in milliseconds: nobody waits so many seconds in an exercise."""


_TOLERANCE = 0.1
_SELDOM_S = 5.0
"""A timer of this period, in seconds, hardly ticks while a check looks."""


def periods(file: NodeFile) -> Iterator[ast.expr]:
    """The expressions of timers' periods: the arguments, and what is assigned to them."""
    for timer in file.timers:
        if (period := argument(timer, "timer_period_sec")) is not None:
            yield from (period, *values_of(ast.unparse(period), file.tree))


@mistake(
    "rate-used-as-a-period",
    explains=[Symptom.WRONG_RATE],
    evidence=Evidence.RUN,
    says="{name} is a rate in Hz, but the timer waits that many seconds, so a higher rate gives fewer messages",
    do="Give the timer the period that belongs to this rate: create_timer takes seconds between two calls.",
    example=in_run(Symptom.WRONG_RATE, parameter="blinks_per_second", unit="Hz", inverted=True),
)
def rate_as_period(case: Case) -> Iterator[Found]:
    """A rate in Hz is given to a timer, which takes seconds.

    create_timer takes a period: the time between two calls, in seconds. A rate says how many calls fit into a second.
    One is 1 divided by the other, so at 1 Hz nobody sees a difference, but at 5 Hz the timer fires every 5 seconds.

    Bad:

        self.create_timer(self.blinks_per_second, self.blink)

    Good:

        self.create_timer(1.0 / self.blinks_per_second, self.blink)

    See it: `ros2 topic hz TOPIC`, once at a rate of 2 and once at 10.
    """
    if case.about("rate") is None and any(True for _ in untimed_spin_once(case)):
        return  # there is no rate because the loop that publishes stands still
    if case.about("inverted") and not case.about("unchanged") and case.about("unit", "Hz") == "Hz":
        yield Found({"name": case.about("parameter", "the rate")})


@mistake(
    "period-used-as-a-rate",
    explains=[Symptom.WRONG_RATE],
    evidence=Evidence.RUN,
    says="{name} is a period, but the node publishes that many times a second, so a longer period gives more messages",
    do="Give the timer this period as it is, in seconds.",
    example=in_run(Symptom.WRONG_RATE, parameter="seconds_between_blinks", unit="s", inverted=True),
)
def period_as_rate(case: Case) -> Iterator[Found]:
    """A period is treated as if it were a rate.

    The parameter's name promises the time between two messages, but the node divides by it once too often. At 1 second,
    nobody sees a difference.

    Bad:

        self.create_timer(1.0 / self.seconds_between_blinks, self.blink)

    Good:

        self.create_timer(self.seconds_between_blinks, self.blink)

    See it: `ros2 topic hz TOPIC`, once with 0.5 seconds and once with 2.
    """
    if case.about("inverted") and case.about("unit", "Hz") != "Hz":
        yield Found({"name": case.about("parameter", "the period")})


@mistake(
    "period-made-a-whole-number",
    explains=_RATES,
    says="{line} throws away the decimals of the timer's period: {code}",
    do="Compute the period with decimals: a plain division, and no rounding.",
)
def whole_number_period(case: Case) -> Iterator[Found]:
    """A timer's period is cut to whole seconds.

    A period is a number of seconds, and most rates give a fraction of one. Integer division and int() throw the
    fraction away, and a period of 0 makes a timer fire as fast as it can.

    Bad:

        self.create_timer(1 // blinks_per_second, self.blink)

    Good:

        self.create_timer(1 / blinks_per_second, self.blink)

    See it: `ros2 topic hz TOPIC`, once at a rate of 0.7 and once at 5.
    """
    for file in case.files:
        for period in periods(file):
            if any(match(pattern, period) for pattern in ("$_ // $_", "int($_)", "round($_)")):
                yield found(file, period)


@mistake(
    "wrong-timer-period",
    explains=(*_RATES, Symptom.CALLS_MISSING),
    says="{line}: create_timer takes seconds, and this is {what}",
    do="Give the period in seconds there.",
)
def period_in_another_unit(case: Case) -> Iterator[Found]:
    """A timer's period is in milliseconds, or in another unit.

    create_timer takes seconds, as a number with decimals: rclcpp's 500ms becomes 0.5. Only a timer's attribute
    timer_period_ns is in nanoseconds, of which a second has 1,000,000,000.

    Bad:

        self.create_timer(500, self.blink)

    Good:

        self.create_timer(0.5, self.blink)

    See it: `ros2 topic hz TOPIC`, or the time stamps of the log.
    """
    for file in case.files:
        for period in periods(file):
            match period:
                case ast.BinOp(left=ast.Constant(value=int() | float() as number), op=ast.Div()) if number != 1:
                    yield found(file, period, what=f"{number:g} divided by the rate")
                case ast.Constant(value=int() | float() as number) if number >= MIN_MILLISECONDS:
                    yield found(file, period, what=f"a period of {number:g} seconds")
        for node in file.nodes:
            if isinstance(node, ast.Assign) and "timer_period_ns" in map(last_name, node.targets):
                numbers = [part.value for part in ast.walk(node.value) if isinstance(part, ast.Constant)]
                large = [number for number in numbers if isinstance(number, int | float) and number >= 1000]
                if len(large) == 1 and large[0] != 1e9:
                    yield found(file, node, what=f"nanoseconds, but computed with {large[0]:g} to the second")


@mistake(
    "timer-of-another-period",
    explains=[Symptom.WRONG_RATE, Symptom.NOT_LOGGED],
    says="{line} makes a timer of {period:g} s, so it ticks {how}: {code}",
    do="Work out how many seconds there should be between two ticks, and give the timer that period.",
    example=in_run(Symptom.WRONG_RATE, wanted_hz=4.0, found_hz=1.0),
)
def another_period(case: Case) -> Iterator[Found]:
    """A timer has the wrong period.

    create_timer takes the time between two ticks, in seconds. For a given number of ticks per second, it is 1 divided
    by that number.

    Bad:

        self.create_timer(1.0, self.blink)

    Good:

        self.create_timer(0.25, self.blink)

    See it: `ros2 topic hz TOPIC`, or the time stamps of the log.
    """
    wanted, seen = case.about("wanted_hz"), case.about("found_hz")
    for file in case.files if wanted is not None else ():
        for timer in file.timers:
            given = argument(timer, "timer_period_sec")
            values = [given, *(values_of(ast.unparse(given), file.tree) if given is not None else [])]
            numbers = [expression.value for expression in values if isinstance(expression, ast.Constant)]
            for period in numbers:
                if not isinstance(period, int | float) or period <= 0 or abs(period * wanted - 1) < _TOLERANCE:
                    continue
                if seen is not None and abs(period * seen - 1) < _TOLERANCE:
                    yield found(file, timer, period=period, how=f"{seen:.1f} times a second")
                elif case.symptom is Symptom.NOT_LOGGED and len(file.timers) == 1 and period >= _SELDOM_S:
                    yield found(file, timer, period=period, how="too seldom to be seen here")


@mistake(
    "no-such-attribute-of-a-timer",
    explains=_RATES,
    says="{line} sets an attribute that timers do not have, so Python makes a new one that nothing reads: {code}",
    do="Cancel the timer and make one with the new period, or set the attribute that timers do have for it.",
)
def period_attribute(case: Case) -> Iterator[Found]:
    """The period of a timer is set by an attribute that it does not have.

    A timer's period is timer_period_ns, a whole number of nanoseconds. Python lets you assign any other attribute, too,
    and keeps it where nothing looks.

    Bad:

        self.lamp = self.create_timer(1.0, self.blink)
        self.lamp.period = 0.2

    Good:

        self.lamp = self.create_timer(1.0, self.blink)
        self.lamp.timer_period_ns = 200_000_000

    See it: `ros2 topic hz TOPIC` before and after.
    """
    for file in case.files:
        timers = {file.assigned_to(timer) for timer in file.timers} - {""}
        for node in file.nodes:
            match node:
                case ast.Assign(targets=[ast.Attribute(value=timer, attr=name)]) if name in _NO_SUCH_ATTRIBUTES:
                    if ast.unparse(timer) in timers:
                        yield found(file, node)
